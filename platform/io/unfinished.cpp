#include "platform/io/unfinished.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

namespace slabcast {

namespace {

/// What a handler of signals can read at any moment: each is a whole path, or null.
std::array<std::atomic<char*>, 64>& paths() {
    static std::array<std::atomic<char*>, 64> all{};
    return all;
}

} // namespace

Unfinished::Unfinished(const std::filesystem::path& path) {
    char* name = strdup(path.c_str());
    for (std::size_t slot = 0; name != nullptr && slot < paths().size(); ++slot) {
        char* none = nullptr;
        if (paths()[slot].compare_exchange_strong(none, name)) {
            slot_ = static_cast<int>(slot);
            return;
        }
    }
    std::free(name);
}

Unfinished::~Unfinished() {
    if (slot_ >= 0) {
        std::free(paths()[static_cast<std::size_t>(slot_)].exchange(nullptr));
    }
}

void Unfinished::removeAll() noexcept {
    for (int round = 0; round < 2; ++round) { // a folder may hold another
        for (const std::atomic<char*>& path : paths()) {
            const char* name = path.load();
            if (name != nullptr && unlink(name) != 0) {
                rmdir(name);
            }
        }
    }
}

} // namespace slabcast

#include "platform/cli/device_cache.h"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "platform/io/atomic_file.h"

namespace slabcast {

namespace fs = std::filesystem;

Result<fs::path> deviceCachePath(const std::string& kind, const std::string& what,
                                 const gl::Caps& caps) {
    const auto folderIn = [](const char* variable) {
        const char* value = std::getenv(variable);
        return fs::path(value == nullptr ? "" : value);
    };
    fs::path cache = folderIn("XDG_CACHE_HOME");
    if (cache.empty() && !folderIn("HOME").empty()) {
        cache = folderIn("HOME") / ".cache";
    }
    if (cache.empty()) {
        return fail(ErrorCode::InvalidArgument,
                    "there is no place for " + what + ": set XDG_CACHE_HOME or HOME");
    }
    std::string file = kind;
    bool apart = true;
    for (const unsigned char c : caps.renderer) {
        if (std::isalnum(c) != 0) {
            file += std::string(apart ? "-" : "") + static_cast<char>(std::tolower(c));
        }
        apart = std::isalnum(c) == 0;
    }
    return cache / "slabcast" / (file + ".json");
}

Result<void> writeDeviceCache(const fs::path& path, const std::string& text) {
    std::error_code ignored; // what cannot be made is reported as a folder that is not there
    fs::create_directories(path.parent_path(), ignored);
    return writeFileAtomically(path, text);
}

Result<std::optional<std::string>> readDeviceCache(const fs::path& path) {
    std::error_code ignored; // what cannot be asked after cannot be read either: said below
    if (fs::status(path, ignored).type() == fs::file_type::not_found) {
        return std::optional<std::string>{};
    }
    std::ifstream file(path, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(file), {});
    if (file.bad() || !file.is_open()) {
        return fail(ErrorCode::FileUnreadable, "it cannot be read");
    }
    return std::optional(std::move(text));
}

} // namespace slabcast

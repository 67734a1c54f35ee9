#pragma once

#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

namespace slabcast::test {

/// How often the files of a folder are opened, by whatever process, while this lives.
class OpenCounter {
public:
    explicit OpenCounter(const std::filesystem::path& folder) : queue_(inotify_init1(IN_NONBLOCK)) {
        // With closings, for the kernel counts like events in a row as one.
        watch_ = inotify_add_watch(queue_, folder.c_str(), IN_OPEN | IN_CLOSE);
        EXPECT_GE(watch_, 0) << "this system does not tell who opens files";
    }
    ~OpenCounter() { close(queue_); }
    OpenCounter(const OpenCounter&) = delete;
    OpenCounter& operator=(const OpenCounter&) = delete;

    /// By name, since the last call.
    std::map<std::string, int> take() {
        std::map<std::string, int> opened;
        alignas(inotify_event) std::array<char, 65536> bytes{};
        for (ssize_t size = 0; (size = read(queue_, bytes.data(), bytes.size())) > 0;) {
            for (ssize_t at = 0; at < size;) {
                inotify_event event{};
                std::memcpy(&event, bytes.data() + at, sizeof event);
                if ((event.mask & IN_OPEN) != 0 && (event.mask & IN_ISDIR) == 0) {
                    ++opened[bytes.data() + at + sizeof event];
                }
                at += static_cast<ssize_t>(sizeof event + event.len);
            }
        }
        return opened;
    }

private:
    int queue_;
    int watch_ = -1;
};

/// What `work` opens in the folder: each of `files` files, and none more than twice.
template <class Work>
void expectOpenedTwiceAtMost(const std::filesystem::path& folder, std::size_t files,
                             const Work& work) {
    OpenCounter counter(folder);
    work();
    const std::map<std::string, int> opened = counter.take();
    EXPECT_EQ(opened.size(), files);
    for (const auto& [name, times] : opened) {
        EXPECT_LE(times, 2) << name;
    }
}

} // namespace slabcast::test

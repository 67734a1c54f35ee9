#pragma once

#include <filesystem>

namespace slabcast {

/// A file that is being written, or a folder that is to hold a result: it goes, should the program
/// be interrupted while this lives. It does nothing else. Up to 64 at a time; more are not seen to.
/// Threads: any. Tested by: io_write_test.cpp
class Unfinished {
public:
    explicit Unfinished(const std::filesystem::path& path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

    /// Removes all of them, folders where they are empty. For a handler of a signal: it allocates
    /// nothing and waits for nothing. Contract: the program ends next, and no other thread begins
    /// or ends one meanwhile.
    static void removeAll() noexcept;

private:
    int slot_ = -1;
};

} // namespace slabcast

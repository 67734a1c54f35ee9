#include "platform/cli/progress.h"

#include <cstdio>
#include <unistd.h>

#include <fmt/core.h>

namespace slabcast {

namespace {

constexpr const char* kClearLine = "\r\033[K";

} // namespace

Progress::~Progress() {
    if (shown_) {
        fmt::print(stderr, kClearLine);
        std::fflush(stderr);
    }
}

void Progress::show(const std::string& line) {
    if (isatty(STDERR_FILENO) == 0) {
        return;
    }
    shown_ = true;
    fmt::print(stderr, "{}{}", kClearLine, line);
    std::fflush(stderr);
}

} // namespace slabcast

#include "platform/cli/progress.h"

#include <cstdio>
#include <unistd.h>

#include <fmt/core.h>

namespace slabcast {

Progress::Progress(std::string step) : step_(std::move(step)) {}

Progress::~Progress() {
    if (shown_) {
        fmt::print(stderr, "\r\033[K");
        std::fflush(stderr);
    }
}

void Progress::at(int done, int total, const std::string& what) {
    if (isatty(STDERR_FILENO) == 0) {
        return;
    }
    shown_ = true;
    fmt::print(stderr, "\r\033[K{} {}/{} {}", step_, done, total, what);
    std::fflush(stderr);
}

} // namespace slabcast

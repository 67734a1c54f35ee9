#include "platform/cli/progress.h"

#include <cstdio>
#include <unistd.h>

namespace slabcast {

namespace {

void showLine(const std::string& line) {
    if (isatty(STDERR_FILENO) != 0) {
        std::fprintf(stderr, "\r\033[K%s", line.c_str());
        std::fflush(stderr);
    }
}

} // namespace

void say(const std::string& line) {
    showLine(""); // what is shown there is no part of it
    std::fprintf(stderr, "slabcast: %s\n", line.c_str());
}

const Watcher& terminal() {
    static const Watcher watcher{.show = showLine, .say = say};
    return watcher;
}

} // namespace slabcast

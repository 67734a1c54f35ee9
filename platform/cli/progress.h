#pragma once

#include <string>

#include "perf/watcher.h"

namespace slabcast {

/// "slabcast: LINE" on stderr.
void say(const std::string& line);

/// Shows steps as one line on stderr that is written over and is gone in the end, silent where
/// stderr is no terminal; says the rest as say() does.
const Watcher& terminal();

/// A step's line at the terminal.
class Progress : public ProgressLine {
public:
    Progress() : ProgressLine(terminal()) {}
    explicit Progress(const std::string& line) : ProgressLine(terminal(), line) {}
};

} // namespace slabcast

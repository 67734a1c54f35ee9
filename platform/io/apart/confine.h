#pragma once

#include "platform/io/base/load_options.h"

namespace slabcast::apart {

/// Gives up, for good, what reading a file does not need: more memory than `limits` allow, core
/// dumps, sockets, other programs, and writing, renaming or deleting files. Dies with its parent.
/// Where the system has no seccomp, the limits alone hold. Tested by: io_apart_test.cpp
void confine(const LoadLimits& limits);

} // namespace slabcast::apart

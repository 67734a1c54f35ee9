#pragma once

#include <cstdint>

namespace slabcast {

/// What happens to the GL state that a host has set. Tested by: host_cost_gl_test.cpp
enum class HostState : std::uint8_t {
    Restore, // what was set before a call is set after it: about 94 queries, once per call
    Ours, // nothing is asked and nothing set back: a host that sets its own state before it draws
};

} // namespace slabcast

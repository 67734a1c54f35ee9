#pragma once

#include <cstdint>

namespace slabcast {

/// What happens to the GL state that a host has set. Tested by: host_cost_gl_test.cpp
enum class HostState : std::uint8_t {
    /// What was set before a call is set after it: about 94 queries, once per call.
    Restore,
    /// Nothing is asked and nothing is set back. After every call of the renderer the host sets
    /// again whatever it draws with: program, bound textures and buffers, framebuffer, viewport,
    /// scissor, blending, depth, stencil and culling.
    Ours,
};

} // namespace slabcast

#pragma once

#include "core/gl/api.h"

/// How self-tests draw: one triangle over a target of one row, nothing blended, tested or masked.
namespace slabcast {

inline constexpr const char* kRowVertexText = R"(#version 320 es
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2); // one triangle over the whole target
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

/// For a row of so many pixels. Contract: a gl::StateGuard restores what this changes.
inline void drawPlainly(int pixels) {
    gl::Viewport(0, 0, pixels, 1);
    gl::ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    for (const GLenum off : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST,
                             GL_STENCIL_TEST, GL_RASTERIZER_DISCARD}) {
        gl::Disable(off);
    }
}

} // namespace slabcast

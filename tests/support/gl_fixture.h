#pragma once

#include <gtest/gtest.h>

#include "core/gl/api.h"
#include "core/gl/caps.h"
#include "core/gl/debug.h"

namespace slabcast {

namespace test {

/// The smallest program: fills the viewport with the uniform `tint`.
inline constexpr const char* kTintVertexText = R"(#version 320 es
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
)";
inline constexpr const char* kTintFragmentText = R"(#version 320 es
precision highp float;
uniform vec4 tint;
out vec4 colour;
void main() { colour = tint; }
)";

} // namespace test

/// Gives a test a current GLES 3.2 context, one for the process, and fails the test if it raised a
/// GL error. SLABCAST_MASK_EXTENSIONS ("mobile-strict", or names separated by commas) hides
/// extensions from caps(). Where no context can be made the test fails: a machine without one must
/// not look as if all passed.
class GlTest : public ::testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    const gl::Caps& caps() const;
    gl::GetProc getProc() const;
    void makeCurrent() const; // SetUp has done so; for tests that make contexts of their own

    /// For tests that raise errors on purpose: how many there were since the last call, and forgets
    /// them.
    int takeErrorCount();
};

} // namespace slabcast

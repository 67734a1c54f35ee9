#pragma once

#include <gtest/gtest.h>

#include "core/gl/api.h"
#include "core/gl/caps.h"
#include "core/gl/debug.h"

namespace slabcast {

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

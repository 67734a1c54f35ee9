#pragma once

#include <glm/glm.hpp>

#include "core/draw/fullscreen_pass.h"

namespace slabcast {

/// Termination across planes where the shader cannot see what it is blended with: pixels of a layer
/// that are as good as opaque are marked in a depth buffer beside it, and the planes behind fail
/// the early depth test there. Tested by: termination_gl_test.cpp
class SaturationMarks {
public:
    bool exist() const { return pass_.exists(); }
    /// Does nothing where all is there already. Fails: ShaderCompile.
    Result<void> create();

    /// Of framebuffers with depth: planes fail at marks and leave none. gl::ColorTargets::begin()
    /// removes all marks.
    static void useForPlanes();

    /// Marks in `depth` the pixels of `layer` above an alpha, of a rectangle from the lower left
    /// on. Both are textures; one is read and the other alone is drawn into: no feedback. Leaves
    /// another framebuffer and program bound. Contract: FullscreenPass::begin()'s.
    void mark(GLuint layer, GLuint depth, glm::ivec2 size, double saturatedAlpha) const;

    void forget();

private:
    FullscreenPass pass_;
    gl::Framebuffer depthOnly_;
};

} // namespace slabcast

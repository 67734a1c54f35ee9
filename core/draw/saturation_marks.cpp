#include "core/draw/saturation_marks.h"

#include "core/gl/api.h"

namespace slabcast {

namespace {

/// Planes lie in the middle, marks at 0, what is cleared at 1.
void testDepth(GLboolean write) {
    gl::Disable(GL_POLYGON_OFFSET_FILL);
    gl::Enable(GL_DEPTH_TEST);
    gl::DepthRangef(0.0F, 1.0F);
    gl::DepthFunc(GL_LESS);
    gl::DepthMask(write);
}

} // namespace

Result<void> SaturationMarks::create() {
    if (pass_.exists()) {
        return {};
    }
    depthOnly_ = gl::Framebuffer::make("saturation marks");
    return pass_.create("saturation marks", "pass/mark.frag", {"saturatedAlpha"});
}

void SaturationMarks::useForPlanes() {
    testDepth(GL_FALSE);
}

void SaturationMarks::mark(GLuint layer, GLuint depth, glm::ivec2 size,
                           double saturatedAlpha) const {
    const auto attach = [](GLuint texture) {
        gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    };
    gl::BindFramebuffer(GL_FRAMEBUFFER, depthOnly_.id());
    attach(depth);
    gl::Viewport(0, 0, size.x, size.y);
    testDepth(GL_TRUE);
    const gl::Program& program = pass_.begin(layer);
    gl::Uniform1f(program.uniform("saturatedAlpha"), static_cast<GLfloat>(saturatedAlpha));
    pass_.draw();
    attach(0); // what is attached lives on when its owner lets it go
}

void SaturationMarks::forget() {
    pass_.forget();
    depthOnly_.forget();
}

} // namespace slabcast

#include "core/draw/plane_blending.h"

namespace slabcast {

void useBlending(GLenum source, GLenum destination) {
    for (const GLenum off : {GL_CULL_FACE, GL_DEPTH_TEST, GL_DITHER, GL_POLYGON_OFFSET_FILL,
                             GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE,
                             GL_SAMPLE_MASK, GL_SCISSOR_TEST, GL_STENCIL_TEST}) {
        gl::Disable(off);
    }
    gl::DepthMask(GL_FALSE);
    gl::ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl::Enable(GL_BLEND);
    gl::BlendEquation(GL_FUNC_ADD);
    gl::BlendFunc(source, destination);
}

void usePlaneBlending(BlendOrder order) {
    order == BlendOrder::BackToFront ? useBlending(GL_ONE, GL_ONE_MINUS_SRC_ALPHA)
                                     : useBlending(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
}

} // namespace slabcast

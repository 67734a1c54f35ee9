#include "core/draw/plane_blending.h"

namespace slabcast {

BlendSwitch::BlendSwitch(Blending first) : now_(first) {
    // Without the depth test neither depth mask nor polygon offset matter.
    for (const GLenum off : {GL_CULL_FACE, GL_DEPTH_TEST, GL_DITHER, GL_RASTERIZER_DISCARD,
                             GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK,
                             GL_SCISSOR_TEST, GL_STENCIL_TEST}) {
        gl::Disable(off);
    }
    gl::ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl::Enable(GL_BLEND);
    gl::BlendEquation(GL_FUNC_ADD);
    gl::BlendFunc(first.source, first.destination);
}

void BlendSwitch::to(Blending blending) {
    if (blending != now_) {
        gl::BlendFunc(blending.source, blending.destination);
        now_ = blending;
    }
}

Blending planeBlending(BlendOrder order) {
    return order == BlendOrder::BackToFront ? kOver : kUnder;
}

} // namespace slabcast

#include "core/draw/plane_blending.h"

#include <array>

#include "core/plan/accumulate_rules.h"

namespace slabcast {

namespace {

/// By PlaneBlend.
constexpr std::array kPlaneBlendings = {kOver, kUnder};

} // namespace

BlendSwitch::BlendSwitch(Blending first) : now_(first) {
    // Without the depth test neither depth mask nor polygon offset matter.
    for (const GLenum off : {GL_CULL_FACE, GL_DEPTH_TEST, GL_DITHER, GL_RASTERIZER_DISCARD,
                             GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK,
                             GL_SCISSOR_TEST, GL_STENCIL_TEST}) {
        gl::Disable(off);
    }
    gl::ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl::Enable(GL_BLEND);
    gl::BlendEquation(first.equation);
    gl::BlendFunc(first.source, first.destination);
}

void BlendSwitch::to(Blending blending) {
    if (blending == now_) {
        return;
    }
    if (blending.equation != now_.equation) {
        gl::BlendEquation(blending.equation);
    }
    gl::BlendFunc(blending.source, blending.destination);
    now_ = blending;
}

Blending planeBlending(const FramePlan& plan) {
    const AccumulateRule& rule = ruleOf(plan.variant.accumulate);
    const PlaneBlend blend =
        plan.order == BlendOrder::BackToFront ? rule.backToFront : rule.frontToBack;
    return kPlaneBlendings[static_cast<std::size_t>(blend)];
}

} // namespace slabcast

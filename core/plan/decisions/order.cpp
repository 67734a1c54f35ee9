#include <algorithm>
#include <cmath>

#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

/// Front to back pays where the densest material makes a ray opaque within this share of the
/// lattice: what is usual in a volume takes many times that length. Measured on a CT skull under
/// bone presets of several opacities: 0.006 saves 4 to 5 layers in 10, 0.024 two, and times follow;
/// 0.04 saves less than one, 0.07 nearly none, and frames take as long or longer.
constexpr double kGoodPart = 0.025;
/// What a pass that marks costs per pixel, and what a plane's fragment costs beside its layers,
/// both in layers: measured on a software driver. A tiler also stores and loads the layer at a
/// mark.
constexpr double kLayersPerMark = 1.0;
constexpr double kLayersPerFragment = 4.0;
/// Up to this length of segments a software driver is faster with marks than where the shader sees
/// the target: they spare launching fragments, which a tiler does for less than a mark.
constexpr int kLaunchCounts = 4;

/// Of the densest material, straight ahead, until a ray is as good as opaque.
double layersToSaturate(const PlanInput& in, const FramePlan& plan) {
    return -std::log1p(-*terminationOf(in, plan)) /
           (in.facts.maxExtinctionPerMm * plan.lattice.spacingMm);
}
double planesToSaturate(const PlanInput& in, const FramePlan& plan) {
    return std::ceil(layersToSaturate(in, plan) / plan.layersPerPlane);
}

/// Alpha gathers until what a plane adds to it is rounded away.
bool targetSaturates(const PlanInput& in, const FramePlan& plan) {
    const double saturated = *terminationOf(in, plan) - halfStepBelowOne(plan.target);
    const double lacking = 1.0 - saturated;
    const double most = -std::expm1(-straightDepthOf(in, plan, plan.layersPerPlane));
    return lacking * most >= halfStepBelowOne(plan.target);
}

/// Why planes behind opaque material are not left out; OrderFrontToBack where they can be.
Reason chosen(const PlanInput& in, const FramePlan& plan) {
    if (!terminationOf(in, plan)) {
        return {ReasonId::OrderWithoutTermination};
    }
    if (plan.planes == 1) {
        return {ReasonId::OrderOfOnePlane};
    }
    const double least = layersToSaturate(in, plan);
    if (least > kGoodPart * plan.lattice.total) {
        return {ReasonId::OrderTooThin, {0.0, least, double(plan.lattice.total)}};
    }
    if (!targetSaturates(in, plan)) {
        return {ReasonId::OrderTargetRounds, {0.0, double(plan.target)}};
    }
    return {ReasonId::OrderFrontToBack, {0.0, planesToSaturate(in, plan), double(plan.planes)}};
}

/// With N planes, a mark of the cost m after every k of them and planes of the cost f, marks cost
/// N/k m, and a pixel that saturates is drawn on over k/2 planes on average: k = sqrt(2 N m/f)
/// makes the sum least. Before a pixel can be opaque there is nothing to mark, so k is at least the
/// number of planes which that takes.
void chooseMarks(const PlanInput& in, FramePlan& plan) {
    const double planeCost = kLayersPerFragment + plan.layersPerPlane;
    const double balanced = std::sqrt(2.0 * plan.planes * kLayersPerMark / planeCost);
    const double least = planesToSaturate(in, plan);
    const double apart = std::ceil(std::max(balanced, least));
    if (!(apart < plan.planes)) {
        because(plan, ReasonId::NoMarks, {apart, double(plan.planes)});
        return;
    }
    plan.planesPerMark = static_cast<int>(apart);
    because(plan, ReasonId::Marks, {apart, least, balanced});
}

} // namespace

Result<void> decideOrder(const PlanInput& in, FramePlan& plan) {
    const auto& [facts, settings, caps, measurements] = in;
    Reason reason = chosen(in, plan);
    plan.order =
        settings.order.value_or(reason.id == ReasonId::OrderFrontToBack ? BlendOrder::FrontToBack
                                                                        : BlendOrder::BackToFront);
    if (settings.order) {
        reason = {ReasonId::OrderAsked};
    }
    reason.numbers[0] = double(plan.order);
    plan.reasons.add(reason);
    if (plan.order == BlendOrder::BackToFront || !terminationOf(in, plan) || plan.planes == 1) {
        return {};
    }
    if (caps.framebufferFetch && !(caps.isSoftware && plan.layersPerPlane <= kLaunchCounts)) {
        plan.variant.terminates = true;
        plan.variant.fetchesTarget = true;
        because(plan, ReasonId::FetchedTarget);
    } else {
        chooseMarks(in, plan);
    }
    if (plan.variant.fetchesTarget || plan.planesPerMark > 0) {
        plan.terminationAlpha = *terminationOf(in, plan);
    }
    return {};
}

} // namespace slabcast

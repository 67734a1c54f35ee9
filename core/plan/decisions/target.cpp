#include <algorithm>
#include <cmath>

#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

constexpr double kHalfStep8Bit = 0.5 / 255.0;
/// A plane that adds less is off by more than a quarter of it.
constexpr double kFaint8Bit = 4.0 * kHalfStep8Bit;
constexpr double kStepOfHalf = 0x1p-10; // of fp16, relative: a device may take either neighbour
constexpr double kMuchOfAll = 0.5;
constexpr double kHalfStepOfHalf = 0x1p-12; // of fp16 below 1

/// Some material of a ramp from zero is always lost; it matters where even the densest is faint.
void warnOfRounding(const PlanInput& in, FramePlan& plan) {
    const double most = 1.0 - std::exp(-straightDepthOf(in, plan, plan.layersPerPlane));
    const bool eightBits = plan.target == TargetFormat::Rgba8;
    // What a plane's rounding takes shows through the planes before it.
    const double halfLost = kStepOfHalf * std::min<double>(plan.planes, 1.0 / most);
    if (!in.facts.anythingVisible || (eightBits ? most >= kFaint8Bit : halfLost < kMuchOfAll)) {
        return;
    }
    if (!eightBits) {
        because(plan, ReasonId::Rgba16fLosesFaintWarning,
                {most, double(plan.planes), 100.0 * std::min(1.0, halfLost)});
    } else if (most >= kHalfStep8Bit) {
        because(plan, ReasonId::Rgba8LosesFaintWarning, {most, 100.0 * kHalfStep8Bit / most});
    } else {
        because(plan, ReasonId::Rgba8LosesAllWarning, {most});
    }
}

} // namespace

double halfStepBelowOne(TargetFormat format) {
    return format == TargetFormat::Rgba8 ? kHalfStep8Bit : kHalfStepOfHalf;
}

Result<void> decideTarget(const PlanInput& in, FramePlan& plan) {
    const Settings& settings = in.settings;
    plan.target = settings.target;
    plan.space = settings.space;
    if (settings.space == CompositingSpace::Linear && settings.target == TargetFormat::Rgba8) {
        plan.target = TargetFormat::Rgba16f;
        because(plan, ReasonId::TargetOfLinearLight);
    } else {
        because(plan, plan.target == TargetFormat::Rgba8 ? ReasonId::TargetRgba8
                                                         : ReasonId::TargetRgba16f);
    }
    warnOfRounding(in, plan);
    return {};
}

} // namespace slabcast

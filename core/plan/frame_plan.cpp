#include "core/plan/frame_plan.h"

#include <algorithm>
#include <tuple>
#include <type_traits>

#include "core/plan/decisions/decision.h"
#include "core/plan/settings_check.h"

namespace slabcast {

namespace {

static_assert(std::is_trivially_copyable_v<FramePlan>); // nothing on the heap

/// Everything but what it was made from and why. A new member does not compile until it is named
/// here.
auto decided(const FramePlan& plan) {
    const auto& [needs, look, lattice, planes, layers, variant, skip, tight, format, space, alpha,
                 order, marks, nothing, reasons, measured] = plan;
    return std::tie(lattice, planes, layers, variant, skip, tight, format, space, alpha, order,
                    marks, nothing);
}

} // namespace

bool FramePlan::operator==(const FramePlan& other) const {
    return decided(*this) == decided(other);
}

const char* name(TargetFormat format) {
    return format == TargetFormat::Rgba8 ? "rgba8" : "rgba16f";
}

const char* name(BlendOrder order) {
    return order == BlendOrder::BackToFront ? "back-to-front" : "front-to-back";
}

double saturatedAlpha(const FramePlan& plan) {
    return plan.terminationAlpha - halfStepBelowOne(plan.target);
}

ShaderVariant cutVariant(const FramePlan& plan) {
    ShaderVariant variant = plan.variant;
    variant.interval = Interval::Box;
    return variant;
}

ShaderVariant variantFor(const FramePlan& plan, const RayFrame& frame, const Frustum& frustum) {
    return plan.variant.interval == Interval::Box || liesBeyondNear(frame, frustum)
               ? plan.variant
               : cutVariant(plan);
}

std::string name(const Ratio& ratio) {
    return std::to_string(ratio.planes) + "x" + std::to_string(ratio.layersPerPlane) +
           (ratio.form == SegmentForm::Unrolled ? " unrolled" : " loop");
}

int totalLayers(const Settings& settings, const SceneFacts& facts) {
    const int covering = settings.totalLayers.value_or(layersToCover(
        facts.sphere.radiusMm, settings.layerSpacingVoxels * facts.smallestVoxelEdgeMm));
    return covering + (settings.jitter ? 1 : 0); // moved by half a layer, they still cover
}

std::vector<Ratio> ratioCandidates(const Settings& settings, const SceneFacts& facts) {
    const int total = totalLayers(settings, facts);
    std::vector<Ratio> candidates;
    for (const int most : {total, 64, 32, 16, 8, 1}) {
        const int layers = std::min(most, total);
        for (const SegmentForm form : {SegmentForm::Loop, SegmentForm::Unrolled}) {
            const bool allowed = settings.form == SegmentForm::Auto || settings.form == form ||
                                 layers < kLoopGroup;
            const bool exists = form == SegmentForm::Loop ? layers >= kLoopGroup
                                                          : unrollLengthFor(layers) != 0;
            const Ratio ratio{planesFor(total, layers), layers, form};
            if (allowed && exists &&
                std::find(candidates.begin(), candidates.end(), ratio) == candidates.end()) {
                candidates.push_back(ratio);
            }
        }
    }
    return candidates;
}

Result<FramePlan> plan(const SceneFacts& facts, const Settings& settings, const gl::Caps& caps,
                       std::span<const RatioMeasurement> measurements) {
    if (Result<void> ok = check(settings, facts); !ok) {
        return tl::unexpected(ok.error());
    }
    const PlanInput input{facts, settings, caps, measurements};
    FramePlan made;
    made.needs = needsOf(settings);
    made.look = facts.look;
    for (const Decision& decision : kDecisions) {
        if (Result<void> done = decision.decide(input, made); !done) {
            return tl::unexpected(done.error());
        }
    }
    return made;
}

} // namespace slabcast

#include <algorithm>

#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

/// Layers per plane where nothing was measured: the middle of the core paper's best range (Fig. 4).
constexpr int kUnmeasuredLayersPerPlane = 16;

SegmentForm formFor(const PlanInput& in, int layersPerPlane) {
    if (in.settings.form != SegmentForm::Auto) {
        return in.settings.form;
    }
    return unrollLengthFor(layersPerPlane) == 0 || in.caps.isSoftware ? SegmentForm::Loop
                                                                      : SegmentForm::Unrolled;
}

Ratio dealtOut(int total, int layersPerPlane, SegmentForm form) {
    const int length = std::min(layersPerPlane, total);
    return {planesFor(total, length), length, length < kLoopGroup ? SegmentForm::Unrolled : form};
}

struct Chosen {
    Ratio ratio;
    ReasonId reason;
};

Chosen chosen(const PlanInput& in, int total) {
    const Settings& settings = in.settings;
    if (settings.planes || settings.layersPerPlane) {
        const int length =
            settings.layersPerPlane ? *settings.layersPerPlane : planesFor(total, *settings.planes);
        const Ratio ratio = dealtOut(total, length, formFor(in, length));
        const bool fewer = settings.planes && ratio.planes < *settings.planes;
        return {ratio, fewer ? ReasonId::RatioOfFewerPlanes : ReasonId::RatioAsked};
    }
    const auto best =
        std::min_element(in.measurements.begin(), in.measurements.end(),
                         [](const auto& a, const auto& b) { return a.frameMs < b.frameMs; });
    if (best == in.measurements.end()) {
        constexpr int kLength = kUnmeasuredLayersPerPlane;
        return {dealtOut(total, kLength, formFor(in, kLength)), ReasonId::RatioUnmeasured};
    }
    // Dealt out anew: what was measured may have been of another number of layers.
    return {dealtOut(total, best->ratio.layersPerPlane, best->ratio.form), ReasonId::RatioFastest};
}

} // namespace

int planesFor(int total, int layersPerPlane) {
    return (total + layersPerPlane - 1) / layersPerPlane;
}

Result<void> decideRatio(const PlanInput& in, FramePlan& plan) {
    const auto [ratio, reason] = chosen(in, plan.lattice.total);
    const bool unrolled = ratio.form == SegmentForm::Unrolled;
    const int length = unrollLengthFor(ratio.layersPerPlane);
    if (unrolled && length == 0) {
        return fail(ErrorCode::InvalidArgument,
                    "segments of " + std::to_string(ratio.layersPerPlane) +
                        " layers are too long to unroll: at most " +
                        std::to_string(kUnrollLengths.back()) + ", or the loop form");
    }
    plan.planes = ratio.planes;
    plan.layersPerPlane = ratio.layersPerPlane;
    plan.variant.unroll = unrolled ? length : 0;
    because(plan, reason,
            {double(ratio.planes), double(ratio.layersPerPlane), unrolled ? 1.0 : 0.0});
    if (reason == ReasonId::RatioFastest) {
        for (const RatioMeasurement& one :
             in.measurements.first(std::min(in.measurements.size(), kMostRatios))) {
            plan.measured.add(one);
        }
    }
    return {};
}

} // namespace slabcast

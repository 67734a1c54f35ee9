#include <algorithm>
#include <optional>

#include "core/plan/decisions/decision.h"
#include "core/plan/known_gpus.h"

namespace slabcast {

namespace {

/// Layers per plane where nothing was measured: the middle of the core paper's best range (Fig. 4).
constexpr int kMiddleLayersPerPlane = 16;

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
    RatioRule rule = RatioRule::Middle; // of RatioUnmeasured
};

bool somethingIsSkipped(const PlanInput& in) {
    const bool built = in.facts.skip.structure != SkipStructure::None;
    return built && (in.settings.skip ? in.settings.skip != SkipStructure::None
                                      : in.facts.occupiedFraction <= kWorthSkipping);
}

/// By the model of a known GPU; nothing of others, or where it cannot be written out as asked for.
std::optional<int> modelledLayers(const PlanInput& in, int total) {
    const KnownGpu* gpu = findKnownGpu(in.caps.renderer);
    if (gpu == nullptr) {
        return std::nullopt;
    }
    const int known = somethingIsSkipped(in) ? gpu->layersSkipping : gpu->layersPlain;
    const int layers = known == 0 ? total : known;
    const bool can = in.settings.form != SegmentForm::Unrolled || unrollLengthFor(layers) != 0;
    return can ? std::optional(layers) : std::nullopt;
}

/// Without a clock: the same device gives the same ratio, whatever else it does. A software driver
/// runs loops as they are and pays for every fragment and every blend, so its rays are whole; that
/// says nothing of a GPU.
Chosen byRule(const PlanInput& in, int total) {
    if (const std::optional<int> layers = modelledLayers(in, total)) {
        return {dealtOut(total, *layers, formFor(in, *layers)), ReasonId::RatioUnmeasured,
                RatioRule::Modelled};
    }
    const bool whole = in.caps.isSoftware && in.settings.form != SegmentForm::Unrolled;
    const int length = whole ? total : kMiddleLayersPerPlane;
    return {dealtOut(total, length, formFor(in, length)), ReasonId::RatioUnmeasured,
            whole ? RatioRule::WholeRays : RatioRule::Middle};
}

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
        return byRule(in, total);
    }
    // Dealt out anew: what was measured may have been of another number of layers.
    return {dealtOut(total, best->ratio.layersPerPlane, best->ratio.form), ReasonId::RatioFastest};
}

} // namespace

int planesFor(int total, int layersPerPlane) {
    return (total + layersPerPlane - 1) / layersPerPlane;
}

Result<void> decideRatio(const PlanInput& in, FramePlan& plan) {
    const auto [ratio, reason, rule] = chosen(in, plan.lattice.total);
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
    const KnownGpu* gpu = findKnownGpu(in.caps.renderer);
    const auto index = gpu == nullptr ? 0.0 : static_cast<double>(gpu - kKnownGpus);
    because(plan, reason,
            {double(ratio.planes), double(ratio.layersPerPlane), unrolled ? 1.0 : 0.0, double(rule),
             index});
    if (reason == ReasonId::RatioFastest) {
        for (const RatioMeasurement& one :
             in.measurements.first(std::min(in.measurements.size(), kMostRatios))) {
            plan.measured.add(one);
        }
    }
    return {};
}

} // namespace slabcast

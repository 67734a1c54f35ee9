#include "perf/stability/phone_cost.h"

#include "core/scene/known_devices.h"
#include "perf/model/segment_costs.h"

namespace slabcast::stability {

namespace {

constexpr glm::ivec2 kSize(64, 64); // of what is counted

} // namespace

Result<FrameWork> workOfMillion(Bench& bench, const Scene& scene, const Settings& settings,
                                const View& view, double raysPerPixel) {
    const Result<FramePlan> plan = bench.plan(scene, settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    SLABCAST_EXPECTS(plan->variant.unroll != 0, plan->layersPerPlane);
    const Result<WorkCounters> counted = bench.countWork(scene, *plan, view, kSize);
    if (!counted) {
        return tl::unexpected(counted.error());
    }
    FrameWork work;
    work.pixels = 1e6;
    const double scale = work.pixels / (double(kSize.x) * kSize.y);
    work.fragments = double(counted->fragments) * scale;
    work.rays = raysPerPixel * work.pixels;
    work.layers = double(counted->layersEvaluated) * scale;
    work.volumeFetches = double(counted->volumeFetches) * scale;
    work.looks = double(counted->skipFetches) * scale;
    return work;
}

Result<std::optional<ModelTerms>> modelledOn(const GpuRates& gpu, const Bench& bench,
                                             const Scene& scene, const Settings& settings,
                                             const FrameWork& work) {
    const KnownDevice* device = findKnownDevice(gpu.name);
    SLABCAST_EXPECTS(device != nullptr, gpu.megahertz);
    const Result<FramePlan> plan =
        slabcast::plan(scene.facts(), settings, assumedCaps(*device, bench.caps()), {});
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    const std::optional<SegmentCosts> costs = segmentCosts(gpu.compiler, plan->variant);
    if (!costs) {
        return std::optional<ModelTerms>();
    }
    FrameWork there = work;
    there.bytesPerPixel = plan->target == TargetFormat::Rgba8 ? 4.0 : 8.0;
    there.layerOfOurOwn = plan->order == BlendOrder::FrontToBack;
    there.filtered = !plan->variant.exactField;
    return std::optional(modelFrame(there, *costs, gpu));
}

} // namespace slabcast::stability

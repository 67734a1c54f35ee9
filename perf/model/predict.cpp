#include "perf/model/predict.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/scene/known_devices.h"
#include "perf/model/divergence.h"
#include "perf/model/segment_costs.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

double layersIn(const PixelWork& pixel) {
    return static_cast<double>(pixel.layersEvaluated);
}
double looksIn(const PixelWork& pixel) {
    return static_cast<double>(pixel.skipFetches);
}

double raysOf(std::span<const PixelWork> work) {
    return static_cast<double>(std::count_if(
        work.begin(), work.end(), [](const PixelWork& pixel) { return pixel.fragments > 0; }));
}

WorkCounters sumOf(std::span<const PixelWork> work) {
    WorkCounters sum;
    for (const PixelWork& pixel : work) {
        sum += pixel;
    }
    return sum;
}

/// All but how waves diverge.
FrameWork frameWork(const Stage& stage, const FramePlan& plan, const WorkCounters& counters) {
    const glm::ivec2 size = stage.desc().size;
    FrameWork work;
    work.pixels = static_cast<double>(size.x) * size.y;
    work.fragments = static_cast<double>(counters.fragments);
    work.layers = static_cast<double>(counters.layersEvaluated);
    work.volumeFetches = static_cast<double>(counters.volumeFetches);
    work.looks = static_cast<double>(counters.skipFetches);
    if (plan.variant.unroll == 0) {
        const double groups = work.layers / layersPerGroup(plan.variant);
        work.turns = std::max(groups, work.looks);
    }
    work.volumeBytes = static_cast<double>(stage.info().forecast.gpuTexelBytes);
    work.views = stage.desc().stereoIpdMm ? 2 : 1;
    work.bytesPerPixel = plan.target == TargetFormat::Rgba8 ? 4.0 : 8.0;
    work.layerOfOurOwn = plan.order == BlendOrder::FrontToBack;
    work.filtered = !plan.variant.exactField;
    return work;
}

} // namespace

Result<FramePlan> planOn(const GpuRates& gpu, const Stage& stage, const Settings& settings) {
    const KnownDevice* device = findKnownDevice(gpu.name);
    SLABCAST_EXPECTS(device != nullptr, gpu.megahertz);
    return plan(stage.scene().facts(), settings, assumedCaps(*device, stage.caps()), {});
}

Result<std::vector<Prediction>> predictions(const Stage& stage, const Settings& settings,
                                            std::span<const PixelWork> work) {
    const glm::ivec2 size = stage.desc().size;
    const WorkCounters counters = sumOf(work);
    std::vector<Prediction> all;
    for (const GpuRates& gpu : gpuRates()) {
        const Result<FramePlan> plan = planOn(gpu, stage, settings);
        if (!plan) {
            return tl::unexpected(plan.error());
        }
        const std::optional<SegmentCosts> costs = segmentCosts(gpu.compiler, plan->variant);
        if (!costs) {
            continue;
        }
        Prediction one{&gpu, *plan, frameWork(stage, *plan, counters), {}};
        const glm::ivec2 wave(gpu.waveWidth, gpu.waveHeight);
        one.work.rays = raysOf(work);
        one.work.layerDivergence = divergence(work, size, wave, layersIn);
        one.work.lookDivergence = divergence(work, size, wave, looksIn);
        one.terms = modelFrame(one.work, *costs, gpu);
        all.push_back(one);
    }
    return all;
}

} // namespace slabcast

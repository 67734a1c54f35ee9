#include <algorithm>
#include <cmath>

#include "perf/stability/conditions.h"
#include "perf/stability/extreme_plans.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "extreme-plans";
constexpr glm::ivec2 kSize(48, 48);
constexpr TargetFormat kTargets[] = {TargetFormat::Rgba8, TargetFormat::Rgba16f};

Settings settingsFor(TargetFormat target, int layersPerPlane) {
    return settingsOf({.name = "", .layersPerPlane = layersPerPlane, .target = target});
}

std::vector<glm::dvec4> exactOf(const Picture& picture) {
    return {picture.pixels.begin(), picture.pixels.end()};
}

/// What two pictures of one lattice may differ by: each is rounded at every plane, and every layer
/// by float32.
double roundingOf(const FramePlan& a, const FramePlan& b) {
    const double float32 = 2.0 * a.lattice.total * 0x1p-22;
    return a.planes * roundingPerPlane(a.target) + b.planes * roundingPerPlane(b.target) + float32;
}

/// One case: what `settings` draws against `reference`, which is of the same lattice.
void recordAgainst(Bench& bench, Case c, const Scene& scene, const Settings& settings,
                   const Result<Drawn>& reference) {
    if (!reference) {
        return bench.recordFailure(std::move(c), reference.error());
    }
    bench.examine(std::move(c), scene, settings, planView(scene, kSize), kSize,
                  [&](Case& judged, const Drawn& drawn) {
                      judged.bound += roundingOf(drawn.plan, reference->plan);
                      judged.measured =
                          largestDifference(drawn.picture, exactOf(reference->picture));
                  });
}

} // namespace

void planRatioCases(Bench& bench, const PlanScenes& scenes) {
    constexpr int kRatios[] = {1, 2, 3, 5, 8, 12, 16, 24, 32, 41};
    for (const TargetFormat target : kTargets) {
        const Result<Drawn> rayCasting = bench.draw(scenes.ball, settingsFor(target, kAllLayers),
                                                    planView(scenes.ball, kSize), kSize);
        for (const int layersPerPlane : kRatios) {
            recordAgainst(bench,
                          {.family = kFamily,
                           .name = named({"ratio of " + std::to_string(layersPerPlane) +
                                              " layers per plane against ray casting",
                                          name(target)}),
                           .quantity = "largest difference, of full scale",
                           .reason = std::string("one lattice, the same samples: only the order of "
                                                 "rounding differs; 2^-22 per layer in float32, "
                                                 "and in both pictures ") +
                                     kRoundingReason},
                          scenes.ball, settingsFor(target, layersPerPlane), rayCasting);
        }
    }
}

void planFormCases(Bench& bench, const PlanScenes& scenes) {
    for (const TargetFormat target : kTargets) {
        for (const int length : {4, 16, 64}) {
            Settings settings = settingsFor(target, length);
            settings.layerSpacingVoxels = 0.5;
            settings.form = SegmentForm::Loop;
            const Result<Drawn> loop =
                bench.draw(scenes.ball, settings, planView(scenes.ball, kSize), kSize);
            settings.form = SegmentForm::Unrolled;
            recordAgainst(
                bench,
                {.family = kFamily,
                 .name = named(
                     {std::to_string(length) + " layers unrolled against the loop", name(target)}),
                 .quantity = "largest difference, of full scale",
                 .reason = std::string("the same samples, the same order: 2^-22 per "
                                       "layer in float32, and where that turns a "
                                       "rounding in either picture, ") +
                           kRoundingReason},
                scenes.ball, settings, loop);
        }
    }
    Settings settings = settingsFor(TargetFormat::Rgba8, 65);
    settings.totalLayers = 100;
    settings.form = SegmentForm::Unrolled;
    const Result<FramePlan> beyond = bench.plan(scenes.ball, settings);
    bench.record(
        {.family = kFamily,
         .name = "65 layers unrolled are refused",
         .quantity = "1 where a plan is made or the error is another",
         .reason = "the unroll list ends at 64: InvalidArgument",
         .measured = !beyond && beyond.error().code == ErrorCode::InvalidArgument ? 0.0 : 1.0});
}

void planTerminationCases(Bench& bench, const PlanScenes& scenes) {
    constexpr struct {
        const char* name;
        double opacity;
    } kThresholds[] = {{"termination at 0.9", 0.9},
                       {"termination at 1 - 1/256", 1.0 - 1.0 / 256.0}};
    for (const Method& method : methods()) {
        if (method.layersPerPlane == 1) {
            continue; // nothing to leave
        }
        Settings settings = settingsOf(method);
        const Result<Drawn> whole =
            bench.draw(scenes.dense, settings, planView(scenes.dense, kSize), kSize);
        for (const auto& threshold : kThresholds) {
            settings.termination = threshold.opacity;
            recordAgainst(
                bench,
                {.family = kFamily,
                 .name = named({threshold.name, method.name}),
                 .quantity = "largest difference, of full scale",
                 .bound = 1.0 - threshold.opacity,
                 .reason = std::string(
                               "a segment that is left early is closed in its own colour: at most "
                               "1 - a of what its pixel shows is not what it would be; "
                               "2^-22 per layer, and in both pictures ") +
                           kRoundingReason},
                scenes.dense, settings, whole);
        }
    }
}

} // namespace slabcast::stability

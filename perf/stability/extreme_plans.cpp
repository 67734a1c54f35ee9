#include "perf/stability/extreme_plans.h"

#include <cmath>

#include "perf/stability/conditions.h"
#include "perf/stability/expected.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "extreme-plans";
constexpr int kEdge = 24; // voxels
constexpr double kUniformValue = 100.0;
constexpr glm::dvec3 kUniformColor(1.0, 0.5, 0.25); // exact in fp16

/// 1 in the centre, 0 from 9 voxels on.
Volume ballVolume() {
    return formulaVolume(glm::ivec3(kEdge), VoxelType::U8, [](glm::ivec3 v) {
        const double away = glm::length(glm::dvec3(v) + 0.5 - kEdge / 2.0);
        return 255.0 * std::max(0.0, 1.0 - away / 9.0);
    });
}

TransferFunction ballTransfer(double mostOpacity) {
    return {.name = "ball",
            .points = {{30.0, {1.0, 0.3, 0.1}, 0.0}, {255.0, {0.2, 0.6, 1.0}, mostOpacity}}};
}

/// Ten thousand layers in float64 take their time.
glm::ivec2 sizeOf(const Bench& bench) {
    return glm::ivec2(bench.reduced() ? 10 : 24);
}

/// One way to sample and to deal out.
struct ExtremePlan {
    const char* name;
    std::optional<int> totalLayers;
    double layerSpacingVoxels;
    int layersPerPlane; // 0: slicing, hybrid and ray casting
};
constexpr ExtremePlan kPlans[] = {
    {"1 layer", 1, 1.0, kAllLayers},
    {"one layer of 100 voxels for the whole volume", std::nullopt, 100.0, kAllLayers},
    {"layers of 0.77 voxels", std::nullopt, 0.77, 0},
    {"layers of pi voxels", std::nullopt, 3.14159265358979, 0},
    {"65 layers per plane", std::nullopt, 0.25, 65},
    {"1,000 layers per plane", 2500, 1.0, 1000},
    {"1 plane of 10,000 layers", 10000, 1.0, kAllLayers},
    {"10,000 planes", 10000, 1.0, 1},
};

Settings settingsOf(const ExtremePlan& plan, const Method& method) {
    Settings settings = stability::settingsOf(method);
    settings.totalLayers = plan.totalLayers;
    settings.layerSpacingVoxels = plan.layerSpacingVoxels;
    if (plan.layersPerPlane > 0) {
        settings.layersPerPlane = plan.layersPerPlane;
    }
    return settings;
}

/// Of plans that fix the layers per plane the methods differ in the target alone.
std::string nameOf(const ExtremePlan& plan, const Method& method) {
    return named({plan.name, plan.layersPerPlane > 0 ? name(method.target) : method.name});
}
bool differs(const ExtremePlan& plan, const Method& method) {
    return plan.layersPerPlane == 0 || method.layersPerPlane == 1;
}

/// Judges by the pixels' own bounds, or by what the plan says where none of them could fail.
void recordPicture(Bench& bench, Case c, const Exhibit& exhibit, const Drawn& drawn,
                   const ExpectedPicture& expected, double extinctionPerMm) {
    const Verdict verdict = judge(exhibit, drawn.picture, expected,
                                  blendingBounds(exhibit, drawn.plan, extinctionPerMm));
    if (verdict.lit == 0) {
        return recordLoss(bench, c, exhibit.scene, drawn,
                          "rounding at so many planes may take all that there is: the plan has to "
                          "say so");
    }
    c.quantity = "worst share of a pixel's own bound";
    c.bound = 1.0;
    c.measured = verdict.share;
    bench.record(std::move(c));
}

/// Against the same samples in float64.
void recordBall(Bench& bench, const ExtremePlan& plan, const Method& method, const Scene& ball) {
    const Exhibit exhibit{kFamily, plan.name, ball, planView(ball, sizeOf(bench)), sizeOf(bench)};
    Case c{.family = kFamily, .name = nameOf(plan, method), .reason = kPixelBoundReason};
    const Result<Drawn> drawn =
        bench.draw(ball, settingsOf(plan, method), exhibit.view, exhibit.size);
    if (!drawn) {
        return bench.recordFailure(std::move(c), drawn.error());
    }
    if (method.target == TargetFormat::Rgba8) {
        c.pictures.push_back({plan.name, drawn->picture});
    }
    recordPicture(bench, std::move(c), exhibit, *drawn, expectedFromSamples(exhibit, drawn->plan),
                  0.0);
}

/// Against the closed form, with and without jitter: neither layers nor their place may show.
void recordUniform(Bench& bench, const ExtremePlan& plan, const Method& method,
                   const Scene& uniform, bool jitter) {
    const Exhibit exhibit{kFamily, plan.name, uniform, planView(uniform, sizeOf(bench)),
                          sizeOf(bench)};
    const double extinction = lookUp(uniform.table(), kUniformValue).w;
    Case c{.family = kFamily,
           .name =
               named({nameOf(plan, method), jitter ? "one material, jittered" : "one material"}),
           .reason = "alpha = 1 - exp(-extinction x chord): neither the number of layers nor their "
                     "place is in it; a pixel's own bound is float32's part in the ray (2^-22 of a "
                     "position's terms, 2^-21 of the layers' number), 2^-21 per layer, and the "
                     "target's rounding at every plane, seen through what lies in front of it"};
    Settings settings = settingsOf(plan, method);
    settings.jitter = jitter;
    const Result<Drawn> drawn = bench.draw(uniform, settings, exhibit.view, exhibit.size);
    if (!drawn) {
        return bench.recordFailure(std::move(c), drawn.error());
    }
    recordPicture(bench, std::move(c), exhibit, *drawn,
                  expectedOfUniform(exhibit, drawn->plan, extinction, kUniformColor), extinction);
}

/// Tight planes, and space skipped, against neither.
void recordSkipping(Bench& bench, const ExtremePlan& plan, const Method& method,
                    const Scene& ball) {
    const glm::ivec2 size = sizeOf(bench);
    const View view = planView(ball, size);
    Settings settings = settingsOf(plan, method);
    const Result<Drawn> plain = bench.draw(ball, settings, view, size);
    Case c{.family = kFamily,
           .name = named({nameOf(plan, method), "skipping"}),
           .quantity = "pixels that differ in any bit",
           .reason = "what is skipped or outside tight planes is invisible, and no sample moves: "
                     "the same operations on the same numbers"};
    settings.tighten = true;
    for (const SkipStructure skip : {SkipStructure::None, SkipStructure::Proximity}) {
        settings.skip = skip;
        const Result<Drawn> other = bench.draw(ball, settings, view, size);
        if (!plain || !other) {
            return bench.recordFailure(std::move(c), plain ? other.error() : plain.error());
        }
        c.measured += differingPixels(plain->picture, other->picture);
    }
    bench.record(std::move(c));
}

} // namespace

Result<PlanScenes> planScenes(Bench& bench) {
    Result<Scene> ball = bench.scene(ballVolume(), {.tf = ballTransfer(0.3)});
    Result<Scene> dense = bench.scene(ballVolume(), {.tf = ballTransfer(0.95)});
    Result<Scene> uniform = bench.scene(
        formulaVolume(glm::ivec3(kEdge), VoxelType::U8, [](glm::ivec3) { return kUniformValue; }),
        {.tf = uniformTransfer(0.05, kUniformColor)}, {.structure = SkipStructure::None});
    for (const Result<Scene>* scene : {&ball, &dense, &uniform}) {
        if (!*scene) {
            return tl::unexpected(scene->error());
        }
    }
    return PlanScenes{std::move(*ball), std::move(*dense), std::move(*uniform)};
}

View planView(const Scene& scene, glm::ivec2 size) {
    return orbitView(scene, {33.0, 21.0, 2.5}, 40.0, size);
}

void extremePlanCases(Bench& bench) {
    const Result<PlanScenes> scenes = planScenes(bench);
    if (!scenes) {
        return bench.recordFailure({.family = kFamily, .name = "scenes of extreme plans"},
                                   scenes.error());
    }
    for (const ExtremePlan& plan : kPlans) {
        for (const Method& method : methods()) {
            if (differs(plan, method)) {
                recordBall(bench, plan, method, scenes->ball);
                recordUniform(bench, plan, method, scenes->uniform, false);
                recordUniform(bench, plan, method, scenes->uniform, true);
                recordSkipping(bench, plan, method, scenes->ball);
            }
        }
    }
    planRatioCases(bench, *scenes);
    planFormCases(bench, *scenes);
    planTerminationCases(bench, *scenes);
}

} // namespace slabcast::stability

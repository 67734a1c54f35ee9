#include <numbers>
#include <optional>

#include "perf/error/error_table.h"
#include "perf/error/reference_pictures.h"
#include "perf/error/refinement.h"
#include "perf/error/refinement_scene.h"

namespace slabcast {

namespace {

using Picture = std::vector<glm::dvec4>;

constexpr int kEdge = 32;            // pixels
constexpr int kStepGrid = 32;        // voxels an edge, while the step is refined
constexpr double kFineStepMm = 0.25; // while the grid is
/// An error of so many times what rounding leaves is shifted by half an order's tolerance at most.
constexpr double kAboveRounding = 2.5;

/// One wave along each axis, level at the cube's faces.
double wavesAt(glm::dvec3 uvw) {
    const glm::dvec3 waves = glm::cos(2.0 * std::numbers::pi * uvw);
    return 0.5 + (waves.x + waves.y + waves.z) / 6.0;
}

FormulaInput smoothWaves() {
    return {wavesAt, refinedInput().tf};
}

/// Layers show most where opacity peaks: a tenth of the values is visible.
FormulaInput peakedWaves() {
    FormulaInput input{wavesAt, refinedInput().tf};
    input.tf.name = "one peak";
    input.tf.opacityUnitMm = kCubeMm / 16.0;
    input.tf.points = {{.value = 0.45, .color = {0.1, 0.3, 0.9}, .opacity = 0.0},
                       {.value = 0.5, .color = {1.0, 0.6, 0.1}, .opacity = 0.6},
                       {.value = 0.55, .color = {0.1, 0.3, 0.9}, .opacity = 0.0}};
    return input;
}

Result<Stage> openStage(const Device& device, const FormulaInput& input, int edgeVoxels) {
    StageDesc desc;
    desc.size = glm::ivec2(kEdge);
    desc.camera = kRefinedCamera;
    desc.fovDegrees = kRefinedFovDegrees;
    desc.background.reset();
    desc.tf = input.tf;
    desc.settings.skip = SkipStructure::None;
    desc.exactTexels = true;
    desc.keepValues = true;
    Volume volume = refinedVolume(input.field, edgeVoxels);
    const VolumeStatistics statistics = computeStatistics(volume);
    return Stage::open(device, std::move(volume), statistics, std::move(desc));
}

/// By ray casting, every layer of every ray.
Result<Picture> draw(Stage& stage, double stepVoxels) {
    const Sampling sampling{.layerSpacingVoxels = stepVoxels,
                            .layersPerPlane = 0,
                            .classification = Classification::Post,
                            .target = TargetFormat::Rgba16f};
    const Settings settings = withSampling(stage.desc().settings, sampling, stage.scene().facts());
    const Result<FramePlan> plan = stage.plan(settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    return stage.prepare(*plan).and_then([&] { return stage.drawOnNothing(*plan); });
}

double levelOf(const Picture& picture) {
    return rmseOf(picture, Picture(picture.size(), glm::dvec4(0.0)));
}

void addLevel(RefinementStudy& study, double size, const Picture& picture, const Picture& truth,
              const Picture& before) {
    study.levels.push_back(
        {size, rmseOf(picture, truth),
         before.empty() ? std::nullopt : std::optional(rmseOf(picture, before))});
    study.convergence = convergenceOf(study.levels, study.floor);
}

/// What float32 and the target's rounding leave where neither step nor grid errs: the RMSE of a
/// field of one value as a share of its picture's root mean square.
Result<double> roundingOn(const Device& device) {
    FormulaInput even = smoothWaves();
    even.field = [](glm::dvec3 /*uvw*/) { return 0.5; };
    Result<Stage> stage = openStage(device, even, 2);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    return draw(*stage, 0.1).map([&](const Picture& picture) {
        const Picture truth = refinedTruth(even, kEdge);
        return rmseOf(picture, truth) / levelOf(truth);
    });
}

/// Against the exact picture of the same voxels: what is left is the step's.
Result<RefinementStudy> stepStudy(const Device& device, double rounding) {
    Result<Stage> stage = openStage(device, peakedWaves(), kStepGrid);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    const Picture truth = continuousPicture(*stage);
    RefinementStudy study{.kind = "step",
                          .method = "the device's ray casting",
                          .unit = "mm",
                          .whyExpected = "as midpoint, on trilinear voxels under a peak of opacity",
                          .floor = kAboveRounding * rounding * levelOf(truth)};
    Picture before;
    for (const double stepVoxels : {2.0, 1.0, 0.5, 0.25}) {
        Result<Picture> picture = draw(*stage, stepVoxels);
        if (!picture) {
            return tl::unexpected(picture.error());
        }
        addLevel(study, stepVoxels * kCubeMm / kStepGrid, *picture, truth, before);
        before = std::move(*picture);
    }
    return study;
}

/// Against the picture of the formula, with steps so fine that the grid's error is what is left.
Result<RefinementStudy> gridStudy(const Device& device, double rounding) {
    const FormulaInput input = smoothWaves();
    const Picture truth = refinedTruth(input, kEdge);
    RefinementStudy study{.kind = "grid",
                          .method = "the device's ray casting",
                          .unit = "mm",
                          .whyExpected = "as trilinear, with layers of a quarter of a millimetre",
                          .floor = kAboveRounding * rounding * levelOf(truth)};
    Picture before;
    for (const int edge : {3, 6, 12, 24}) {
        Result<Stage> stage = openStage(device, input, edge);
        if (!stage) {
            return tl::unexpected(stage.error());
        }
        Result<Picture> picture = draw(*stage, kFineStepMm * edge / kCubeMm);
        if (!picture) {
            return tl::unexpected(picture.error());
        }
        addLevel(study, kCubeMm / edge, *picture, truth, before);
        before = std::move(*picture);
    }
    return study;
}

} // namespace

Result<std::vector<RefinementStudy>> refineOnDevice(const Device& device) {
    const Result<double> rounding = roundingOn(device);
    if (!rounding) {
        return tl::unexpected(rounding.error());
    }
    std::vector<RefinementStudy> studies;
    for (const auto study : {stepStudy, gridStudy}) {
        Result<RefinementStudy> made = study(device, *rounding);
        if (!made) {
            return tl::unexpected(made.error());
        }
        studies.push_back(std::move(*made));
    }
    return studies;
}

} // namespace slabcast

#include <cmath>
#include <optional>

#include "core/reference/continuous.h"
#include "perf/error/error_table.h"
#include "perf/error/reference_pictures.h"
#include "perf/error/refinement.h"
#include "perf/error/refinement_scene.h"

namespace slabcast {

namespace {

using Picture = std::vector<glm::dvec4>;

constexpr int kEdge = 16;
constexpr int kStepGrid = 32;        // voxels an edge, while the step is refined
constexpr double kFineStepMm = 0.25; // while the grid is
/// One rounding of RGBA16F is 2^-12 of a value near 1, or twice that where a driver cuts off. An
/// error of four times the greater is shifted by less than a tenth of an order's tolerance.
constexpr double kTargetFloor = 4.0 * 0x1p-11;

Result<Stage> openStage(const Device& device, int edgeVoxels) {
    StageDesc desc;
    desc.size = glm::ivec2(kEdge);
    desc.camera = kRefinedCamera;
    desc.fovDegrees = kRefinedFovDegrees;
    desc.background.reset();
    desc.tf = refinedInput().tf;
    desc.settings.skip = SkipStructure::None;
    desc.exactTexels = true;
    desc.keepValues = true;
    Volume volume = refinedVolume(edgeVoxels);
    const VolumeStatistics statistics = computeStatistics(volume);
    return Stage::open(device, std::move(volume), statistics, std::move(desc));
}

/// By ray casting, every layer of every ray.
Result<Picture> draw(Stage& stage, double stepVoxels) {
    const Sampling sampling{.layerSpacingVoxels = stepVoxels,
                            .layersPerPlane = 0,
                            .classification = Classification::Post,
                            .target = TargetFormat::Rgba16f};
    Settings settings = withSampling(stage.desc().settings, sampling, stage.scene().facts());
    const Result<FramePlan> plan = stage.plan(settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    return stage.prepare(*plan).and_then([&] { return stage.drawOnNothing(*plan); });
}

void addLevel(RefinementStudy& study, double size, const Picture& picture, const Picture& truth,
              const Picture& before) {
    study.levels.push_back(
        {size, rmseOf(picture, truth),
         before.empty() ? std::nullopt : std::optional(rmseOf(picture, before))});
    study.convergence = convergenceOf(study.levels, study.floor);
}

/// Against the exact picture of the same voxels: what is left is the step's.
Result<RefinementStudy> stepStudy(const Device& device) {
    RefinementStudy study{.kind = "step",
                          .method = "the device's ray casting",
                          .unit = "mm",
                          .whyExpected = "as midpoint, on trilinear voxels",
                          .floor = kTargetFloor};
    Result<Stage> stage = openStage(device, kStepGrid);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    const Picture truth = continuousPicture(*stage);
    Picture before;
    for (const double stepVoxels : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5}) {
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
Result<RefinementStudy> gridStudy(const Device& device) {
    RefinementStudy study{.kind = "grid",
                          .method = "the device's ray casting",
                          .unit = "mm",
                          .whyExpected = "as trilinear, with layers of a quarter of a millimetre",
                          .floor = kTargetFloor};
    const Picture truth = refinedTruth(kEdge);
    Picture before;
    for (const int edge : {2, 4, 8, 16, 32, 64}) {
        Result<Stage> stage = openStage(device, edge);
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
    std::vector<RefinementStudy> studies;
    for (const auto study : {stepStudy, gridStudy}) {
        Result<RefinementStudy> made = study(device);
        if (!made) {
            return tl::unexpected(made.error());
        }
        studies.push_back(std::move(*made));
    }
    return studies;
}

} // namespace slabcast

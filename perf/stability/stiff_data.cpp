#include <algorithm>
#include <cmath>

#include "perf/stability/conditions.h"
#include "perf/stability/stiff.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr double kHighest = 255.0;

TransferFunction rampTransfer(double mostOpacity) {
    const glm::dvec3 white(1.0);
    return {.name = "ramp", .points = {{0.0, white, 0.0}, {kHighest, white, mostOpacity}}};
}

// --- A sheet of one voxel ---

constexpr int kSheetDims = 33;
constexpr int kSheetMargin = 8; // so that no ray leaves the box within the sheet
constexpr double kSheetOpacity = 0.1;

struct Facing {
    const char* name;
    double azimuthDegrees;
    double voxelsAlong; // of a ray within the sheet, at most; it is 2 voxels thick as a field
    /// Of the depth's error over the densest extinction, for layers of h voxels: of h^2, for the
    /// kinks of the field along a ray, and of h^3, for its curves.
    double kinks, curves;
};
// A kink in a layer moves its depth by h^2 / 8 of what the slope changes by there: at a tent's
// foot, top and foot by 1, 2 and 1 over the cosine to the sheet. A curve moves it by h^3 / 24 of
// the second derivative: of two slopes that meet at the sheet's rim, seen at 45 degrees, by 1 over
// 5 layers. Edge-on, rays stay within the slopes.
constexpr Facing kFacings[] = {{"sheet face-on", 0.0, 2.0, 0.5, 0.01},
                               {"sheet at 45 degrees", 45.0, 3.0, 0.36, 5.0 / 24.0},
                               {"sheet edge-on", 90.0, 18.0, 1.0, 0.5}};

Volume sheetVolume() {
    return formulaVolume(glm::ivec3(kSheetDims), VoxelType::U8, [](glm::ivec3 v) {
        const glm::ivec3 toFace = glm::min(v, kSheetDims - 1 - v);
        const bool inside = toFace.x >= kSheetMargin && toFace.z >= kSheetMargin;
        return inside && v.y == kSheetDims / 2 ? kHighest : 0.0;
    });
}

/// Extinction along any ray rises once and falls once (the field is a product of trapezoids, of
/// which each is log-concave), so it varies by twice its maximum in all.
double sheetBound(const Facing& facing, double layerVoxels, const FramePlan& plan) {
    const double most = extinctionPerMm(kSheetOpacity, 1.0);
    const double h = layerVoxels * 1.0002; // rays lean by 0.02 at most
    const double voxels = std::min(h, (facing.kinks + facing.curves * h) * h * h);
    const double ofCurvedTransfer = facing.voxelsAlong * kSheetOpacity * kSheetOpacity / 8.0;
    const double filter = most * facing.voxelsAlong * (3.0 / 256.0 + 1.0 / 255.0);
    const double planesMet = std::min<double>(
        plan.planes, facing.voxelsAlong / (layerVoxels * plan.layersPerPlane) + 2.0);
    return -std::expm1(-most * voxels) + ofCurvedTransfer + filter + 0x1p-11 / std::exp(1.0) +
           planesMet * roundingPerPlane(plan.target);
}

void recordSheet(Bench& bench, const Scene& scene, const Facing& facing, const Spacing& spacing) {
    constexpr glm::ivec2 kSize(48, 48);
    const View view = distantView(scene, facing.azimuthDegrees, 12.0, kSize);
    const std::vector<glm::dvec4> truth = continuousPicture(scene, view, kSize);
    for (const Method& method : methods()) {
        const Settings settings = settingsOf(method, spacing);
        bench.examine(
            {.family = "stiff",
             .name = named({facing.name, spacing.name, method.name}),
             .quantity = "largest difference from the integral, of full scale",
             .reason =
                 std::string("a midpoint rule's depth is off by half the total variation of "
                             "extinction x layer length; the sheet's rises and falls once: "
                             "the opacity of one layer at its densest; the filter's part over "
                             "the way through the sheet (3/256 of its range and a step of "
                             "R8), the table's 2^-11 / e; ") +
                 kRoundingReason},
            scene, settings, view, kSize, [&](Case& c, const Drawn& drawn) {
                c.bound = sheetBound(facing, spacing.voxels, drawn.plan);
                c.measured = largestDifference(drawn.picture, truth);
                if (isShown(method)) {
                    c.pictures.push_back({"sheet", drawn.picture});
                }
            });
    }
}

// --- A checkerboard at the Nyquist limit ---

constexpr int kBoardDims = 24;
constexpr double kBoardOpacity = 0.02;

Volume boardVolume() {
    return formulaVolume(glm::ivec3(kBoardDims), VoxelType::U8,
                         [](glm::ivec3 v) { return (v.x + v.y + v.z) % 2 * kHighest; });
}

/// Along its axes the board is a wave of two voxels about its mean: samples a voxel apart come in
/// pairs that cancel, whatever the phase.
double boardBound(const FramePlan& plan) {
    const double most = extinctionPerMm(kBoardOpacity, 1.0);
    const double unpaired = 2.0 * most;
    const double curved = kBoardDims * kBoardOpacity * kBoardOpacity / 2.0;
    const double filter = kBoardDims * most * (3.0 / 256.0 + 1.0 / 255.0);
    const double planesMet = std::ceil(kBoardDims * 1.0 / plan.layersPerPlane) + 1.0;
    return unpaired + curved + filter + 0x1p-11 / std::exp(1.0) +
           planesMet * roundingPerPlane(plan.target);
}

void recordBoardFaceOn(Bench& bench, const Scene& board) {
    constexpr glm::ivec2 kSize(48, 48);
    const View view = distantView(board, 0.0, 8.0, kSize);
    const std::vector<glm::dvec4> truth = continuousPicture(board, view, kSize);
    for (const Method& method : methods()) {
        bench.examine(
            {.family = "stiff",
             .name = named({"checkerboard face-on", kSpacings[0].name, method.name}),
             .quantity = "largest difference from the integral, of full scale",
             .reason = std::string(
                           "samples a voxel apart cancel in pairs: one at either end remains; "
                           "extinction's curve over opacity by half of opacity squared x length; "
                           "the filter's part over the box (3/256 of its range and a step of R8), "
                           "the table's 2^-11 / e; ") +
                       kRoundingReason},
            board, settingsOf(method), view, kSize, [&](Case& c, const Drawn& drawn) {
                c.bound = boardBound(drawn.plan);
                c.measured = largestDifference(drawn.picture, truth);
            });
    }
}

/// Against the same samples, where the data are the worst that a filter can meet.
void recordSamples(Bench& bench, const Scene& scene, const char* what, const Spacing& spacing) {
    constexpr glm::ivec2 kSize(32, 32);
    const View view = orbitView(scene, {33.0, 21.0, 2.5}, 40.0, kSize);
    for (const Method& method : methods()) {
        bench.examine({.family = "stiff",
                       .name = named({what, "oblique", spacing.name, method.name}),
                       .quantity = "worst share of a pixel's own bound",
                       .bound = 1.0,
                       .reason = kPixelBoundReason},
                      scene, settingsOf(method, spacing), view, kSize,
                      [&](Case& c, const Drawn& drawn) {
                          c.measured = shareOfPixelBound(scene, drawn, view);
                          if (isShown(method)) {
                              c.pictures.push_back({what, drawn.picture});
                          }
                      });
    }
}

} // namespace

void stiffDataCases(Bench& bench) {
    constexpr SkipOptions kNoSkip{.structure = SkipStructure::None};
    const Result<Scene> sheet =
        bench.scene(sheetVolume(), {.tf = rampTransfer(kSheetOpacity)}, kNoSkip);
    const Result<Scene> board =
        bench.scene(boardVolume(), {.tf = rampTransfer(kBoardOpacity)}, kNoSkip);
    const Result<Scene> dense = bench.scene(boardVolume(), {.tf = rampTransfer(1.0)}, kNoSkip);
    for (const Result<Scene>* scene : {&sheet, &board, &dense}) {
        if (!*scene) {
            return bench.recordFailure({.family = "stiff", .name = "sheets and checkerboards"},
                                       scene->error());
        }
    }
    recordBoardFaceOn(bench, *board);
    for (const Spacing& spacing : kSpacings) {
        for (const Facing& facing : kFacings) {
            recordSheet(bench, *sheet, facing, spacing);
        }
        recordSamples(bench, *dense, "checkerboard", spacing);
        if (!bench.reduced()) {
            recordSamples(bench, *sheet, "sheet", spacing);
        }
    }
}

} // namespace slabcast::stability

#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "perf/stability/exhibit.h"
#include "perf/stability/extreme_values.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "extreme-data";
constexpr double kSigma = 0.0625; // exact in the table's fp16
constexpr glm::dvec3 kColor(1.0, 0.5, 0.25);

glm::ivec2 pictureSize(const Bench& bench) {
    return bench.reduced() ? glm::ivec2(24, 18) : glm::ivec2(56, 42);
}

double scattered(glm::ivec3 v) {
    return 30 + (v.x * 37 + v.y * 59 + v.z * 23) % 200;
}

TransferFunction ramp() {
    return {.name = "ramp",
            .points = {{30.0, {0.1, 0.4, 0.9}, 0.02}, {230.0, {1.0, 0.7, 0.2}, 0.3}}};
}

struct Shape {
    const char* name;
    glm::ivec3 dims;
    glm::dvec3 spacingMm;
    glm::dvec3 eyeMm; // from the centre
    glm::dvec3 forward;
    double fovDegrees;
    double layerSpacingVoxels; // of the structured volume: coarse where a ray meets every plane
};

constexpr glm::dvec3 kCubic(1.0);
constexpr Shape kShapes[] = {
    {"1x1x1", {1, 1, 1}, kCubic, {1.5, -3.0, 1.0}, {-1.5, 3.0, -1.0}, 40.0, 1.0},
    {"3x5x7", {3, 5, 7}, kCubic, {8.0, -14.0, 5.0}, {-8.0, 14.0, -5.0}, 40.0, 1.0},
    {"1x1x2048, from the side",
     {1, 1, 2048},
     kCubic,
     {2.5, -2.5, 0.7},
     {-2.5, 2.5, -0.7},
     50.0,
     1.0},
    {"1x1x2048, end on", {1, 1, 2048}, kCubic, {0.3, 0.2, 1026.0}, {0, 0, -1}, 20.0, 32.0},
    {"2048x2x2, from the side", {2048, 2, 2}, kCubic, {0.3, -4.0, 2.0}, {0, 4, -2}, 50.0, 1.0},
    {"2048x2x2, end on", {2048, 2, 2}, kCubic, {-1028.0, 0.4, 0.2}, {1, 0, 0}, 25.0, 32.0},
    {"spacing 1:1:1000", {20, 16, 4}, {1, 1, 1000}, {30, -25, 3}, {-30, 25, -3}, 45.0, 1.0},
    {"spacing 1:1000:1", {20, 4, 16}, {1, 1000, 1}, {30, 4, 25}, {-30, -4, -25}, 45.0, 1.0},
    {"spacing 1000:1:1", {4, 20, 16}, {1000, 1, 1}, {5, -30, 25}, {-5, 30, -25}, 45.0, 1.0}};

View viewOf(const Shape& shape, const Scene& scene, glm::ivec2 size) {
    const glm::dvec3 eye = scene.geometry().boundingSphere().centreMm + shape.eyeMm;
    const bool upright = std::abs(glm::normalize(shape.forward).z) > 0.99;
    const glm::dvec3 up = upright ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return {.viewFromModel = glm::lookAt(eye, eye + shape.forward, up),
            .frustum = symmetricFrustum(shape.fovDegrees, double(size.x) / size.y)};
}

void shapeCases(Bench& bench, const Shape& shape) {
    const Volume volume = formulaVolume(shape.dims, VoxelType::U8, scattered, shape.spacingMm);
    const Result<Scene> structured = bench.scene(volume, {.tf = ramp()}, {.blockEdgeVoxels = 1});
    const Result<Scene> uniform =
        bench.scene(volume, {.tf = uniformTransfer(1.0 - std::exp(-kSigma), kColor)});
    if (!structured || !uniform) {
        return bench.recordFailure({.family = kFamily, .name = shape.name},
                                   structured ? uniform.error() : structured.error());
    }
    const glm::ivec2 size = pictureSize(bench);
    const View view = viewOf(shape, *structured, size);
    const Exhibit exhibit{.family = kFamily,
                          .name = shape.name,
                          .scene = *structured,
                          .view = view,
                          .size = size,
                          .layerSpacingVoxels = shape.layerSpacingVoxels};
    recordAgainstSamples(bench, exhibit);
    recordSkippingChangesNothing(bench, exhibit);
    recordUniform(
        bench,
        {.family = kFamily, .name = shape.name, .scene = *uniform, .view = view, .size = size},
        kSigma, kColor);
}

glm::ivec3 const kBallDims(20, 16, 24);

double ball(glm::ivec3 v) {
    const double r = glm::length(glm::dvec3(v) - glm::dvec3(10.5, 7.0, 12.0));
    return r < 7.0 ? 140.0 + 100.0 * std::cos(1.3 * r) : 0.0;
}

/// A lit ball whose voxels have the edge `mm`, under a TF of that unit of length.
Result<Scene> ballOfVoxels(Bench& bench, double mm, bool lit) {
    TransferFunction tf = ramp();
    tf.opacityUnitMm = mm;
    Appearance look{.tf = tf};
    if (lit) {
        look.shading = ShadingParameters{};
    }
    return bench.scene(formulaVolume(kBallDims, VoxelType::U8, ball, glm::dvec3(mm)), look);
}

struct Size {
    const char* name;
    double mm;
    double powerOfTwo; // near it
};
constexpr Size kSizes[] = {{"voxels of 1 nm", 1e-6, 0x1p-20}, {"voxels of 1 km", 1e6, 0x1p20}};

void sizeCases(Bench& bench, const Size& voxel) {
    const glm::ivec2 size = pictureSize(bench);
    const double sigma = kSigma / voxel.powerOfTwo; // exact in fp16
    const Result<Scene> millimetres = ballOfVoxels(bench, 1.0, true);
    const Result<Scene> scaled = ballOfVoxels(bench, voxel.powerOfTwo, true);
    const Result<Scene> meant = ballOfVoxels(bench, voxel.mm, false);
    const Result<Scene> uniform =
        bench.scene(formulaVolume(kBallDims, VoxelType::U8, ball, glm::dvec3(voxel.mm)),
                    {.tf = uniformTransfer(1.0 - std::exp(-sigma * voxel.mm), kColor, voxel.mm)});
    for (const Result<Scene>* scene : {&millimetres, &scaled, &meant, &uniform}) {
        if (!*scene) {
            return bench.recordFailure({.family = kFamily, .name = voxel.name}, scene->error());
        }
    }
    const OrbitCamera camera{30.0, 20.0, 2.2};
    const auto exhibit = [&](const Scene& scene, const std::string& name) {
        return Exhibit{.family = kFamily,
                       .name = name,
                       .scene = scene,
                       .view = orbitView(scene, camera, 50.0, size),
                       .size = size,
                       .lattice = LatticeKind::Shells};
    };
    recordSamePicture(bench, exhibit(*millimetres, std::string(voxel.name) + ", lit, as at 1 mm"),
                      *scaled, orbitView(*scaled, camera, 50.0, size),
                      "2^20 = 1.05 x 10^6 times as large or small: a power of two scales every "
                      "length alike and rounds nothing otherwise, and no length is compared with a "
                      "fixed one");
    recordAgainstSamples(bench, exhibit(*meant, voxel.name));
    recordUniform(bench, exhibit(*uniform, voxel.name), sigma, kColor);
}

} // namespace

void extremeDataCases(Bench& bench) {
    for (const Shape& shape : kShapes) {
        shapeCases(bench, shape);
    }
    for (const Size& voxel : kSizes) {
        sizeCases(bench, voxel);
    }
    extremeValueCases(bench, pictureSize(bench));
}

} // namespace slabcast::stability

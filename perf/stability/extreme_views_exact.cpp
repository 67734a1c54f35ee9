#include "perf/stability/extreme_views.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "perf/stability/exhibit.h"
#include "perf/stability/reference_picture.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "extreme-views";

// Inside an opaque voxel --------------------------------------------------------------------------

/// Opaque within a voxel of the middle, all but clear and of another colour outside.
Result<Scene> opaqueMiddle(Bench& bench) {
    const Volume volume = formulaVolume(glm::ivec3(13), VoxelType::U8, [](glm::ivec3 v) {
        return glm::all(glm::lessThanEqual(glm::abs(v - 6), glm::ivec3(1))) ? 200.0 : 50.0;
    });
    return bench.scene(volume, {.tf = {.name = "opaque middle",
                                       .points = {{50.0, {0.0, 0.25, 1.0}, 0.2},
                                                  {200.0, {1.0, 0.5, 0.25}, 1.0}}}});
}

void opaqueVoxelCase(Bench& bench, const Scene& scene, const Method& method, LatticeKind lattice,
                     bool terminates) {
    const glm::ivec2 size(49, 37);
    const View view = {.viewFromModel =
                           glm::lookAt(scene.geometry().boundingSphere().centreMm,
                                       glm::dvec3(100.0, 40.0, 20.0), glm::dvec3(0.0, 0.0, 1.0)),
                       .frustum = symmetricFrustum(75.0, double(size.x) / size.y)};
    Settings settings = settingsOf(method);
    settings.lattice = lattice;
    if (terminates) {
        settings.termination = Settings{}.termination;
    }
    // Half a layer next to the eye at the least lets 2^-12 through, the next one 2^-24 of it.
    const double perPlane = roundingPerPlane(method.target);
    Case result{.family = kFamily,
                .name = std::string("eye inside an opaque voxel, ") + name(lattice) + ", " +
                        (terminates ? "left early, " : "") + method.name,
                .quantity = "largest difference from the voxel's colour, of full scale",
                .bound = 2.0 * perPlane + 0x1p-12 + (terminates ? 1.0 / 256.0 : 0.0),
                .reason = "an opacity of 1 - 2^-24 per mm over one mm at least: nothing behind "
                          "shows; half a layer at the eye lets 2^-12 through, so two planes' "
                          "roundings are seen; and what leaving early may lose, 1/256"};
    bench.examine(std::move(result), scene, settings, view, size, [&](Case& c, const Drawn& drawn) {
        const std::vector<glm::dvec4> meant(drawn.picture.pixels.size(),
                                            glm::dvec4(1.0, 0.5, 0.25, 1.0));
        c.measured = largestDifference(drawn.picture, meant);
    });
}

// Planes on faces ---------------------------------------------------------------------------------

constexpr double kFarRadii = 1e4;

double sheetValue(int index) {
    return 20 + 2 * (index * 37 % 90); // even: the mean of two is a whole number
}

TransferFunction sheets() {
    return {.name = "sheets",
            .points = {{20.0, {0.1, 0.4, 0.9}, 0.02}, {200.0, {1.0, 0.7, 0.2}, 0.3}}};
}

/// A view along an axis towards its higher end, and the volume's size along it and across.
struct Axis {
    const char* name;
    int axis;
    OrbitCamera camera;
};
constexpr Axis kAxes[] = {{"x", 0, {270.0, 0.0, kFarRadii}},
                          {"y", 1, {0.0, 0.0, kFarRadii}},
                          {"z", 2, {0.0, -90.0, kFarRadii}}};

/// Front to back over samples at `values`, each of the length beside it.
PixelReference composite(const TransferFunction& tf, const std::vector<glm::dvec2>& values) {
    PixelReference pixel;
    double extinctions = 0.0;
    for (const glm::dvec2 layer : values) {
        const TransferSample sample = evaluate(tf, layer.x);
        const double extinction = extinctionPerMm(sample.opacity, tf.opacityUnitMm);
        const double alpha = 1.0 - std::exp(-extinction * layer.y);
        extinctions += extinction * layer.y;
        pixel.color += (1.0 - pixel.color.a) * alpha * glm::dvec4(sample.color, 1.0);
    }
    // fp16 in the table: extinction by 2^-11 of itself, colour by as much. Positions: 2^-22 of
    // terms below 4 over 16 voxels, that is 2^-16 of a voxel, across which values differ by up to
    // 180.
    const double valueError = 180.0 * 0x1p-16;
    const double slope = 0.28 / 180.0 / 0.7; // of the extinction by value
    pixel.bound = extinctions * (0x1p-11 + valueError * 0.9 / 180.0) + 0x1p-11 +
                  16.0 * slope * valueError + double(values.size()) * 0x1p-21;
    return pixel;
}

/// Samples in the voxels' middles, layers ending on their faces; or samples on the faces, where the
/// value is the mean of two voxels, and half layers at both ends.
std::vector<glm::dvec2> layersThrough(int sheetCount, bool samplesOnFaces) {
    std::vector<glm::dvec2> layers;
    for (int i = 0; i < sheetCount; ++i) {
        layers.push_back({sheetValue(i), 1.0});
    }
    if (samplesOnFaces) {
        for (int i = sheetCount - 1; i > 0; --i) {
            layers[i].x = (layers[i].x + layers[i - 1].x) / 2.0;
        }
        layers[0].y = 0.5;
        layers.push_back({sheetValue(sheetCount - 1), 0.5});
    }
    return layers;
}

void planesOnFacesCase(Bench& bench, const Axis& axis, bool samplesOnFaces) {
    constexpr int kSheets = 16;
    // The diagonal of 16x16x16 is 27.7: 28 layers, an end in the middle, which is a face. That of
    // 16x16x18 is 28.9: 29 layers, a sample in the middle.
    glm::ivec3 dims(kSheets);
    dims[(axis.axis + 1) % 3] = samplesOnFaces ? 18 : 16;
    const Volume volume =
        formulaVolume(dims, VoxelType::U8, [&](glm::ivec3 v) { return sheetValue(v[axis.axis]); });
    const std::string name = std::string(samplesOnFaces ? "samples" : "layers' ends") +
                             " on the voxels' faces, along " + axis.name;
    const Result<Scene> scene = bench.scene(volume, {.tf = sheets()}, {}, true);
    if (!scene) {
        return bench.recordFailure({.family = kFamily, .name = name}, scene.error());
    }
    const glm::ivec2 size(24, 24);
    // Within the 16 mm across, whatever the axis: 12 of them.
    const double radius = scene->geometry().boundingSphere().radiusMm;
    const Exhibit exhibit{
        .family = kFamily,
        .name = name,
        .scene = *scene,
        .view = orbitView(*scene, axis.camera, glm::degrees(12.0 / (kFarRadii * radius)), size),
        .size = size};
    const PixelReference pixel = composite(sheets(), layersThrough(kSheets, samplesOnFaces));
    recordAgainst(bench, exhibit,
                  "a sum over the sheets, front to back; a pixel's bound adds the table's fp16 "
                  "(2^-11), positions off by 2^-16 of a voxel, 2^-21 per layer, and the target's "
                  "rounding at every plane",
                  ExpectedPicture(static_cast<std::size_t>(size.x) * size.y, pixel));
}

} // namespace

void opaqueVoxelCases(Bench& bench) {
    const Result<Scene> scene = opaqueMiddle(bench);
    if (!scene) {
        return bench.recordFailure({.family = kFamily, .name = "eye inside an opaque voxel"},
                                   scene.error());
    }
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const Method& method : methods()) {
            opaqueVoxelCase(bench, *scene, method, lattice, false);
            opaqueVoxelCase(bench, *scene, method, lattice, true);
        }
    }
}

void planesOnFacesCases(Bench& bench) {
    for (const Axis& axis : kAxes) {
        planesOnFacesCase(bench, axis, false);
        planesOnFacesCase(bench, axis, true);
    }
}

} // namespace slabcast::stability

#include "perf/error/refinement_scene.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/base/parallel.h"

namespace slabcast {

namespace {

/// Source: Marschner and Lobb 1994, section 5, with fM = 1 in place of 6.
double signalAt(glm::dvec3 uvw) {
    constexpr double kAlpha = 0.25;
    const glm::dvec3 p = 2.0 * uvw - 1.0;
    const double wave =
        std::cos(2.0 * std::numbers::pi * std::cos(0.5 * std::numbers::pi * std::hypot(p.x, p.y)));
    return (1.0 - std::sin(0.5 * std::numbers::pi * p.z) + kAlpha * (1.0 + wave)) /
           (2.0 * (1.0 + kAlpha));
}

} // namespace

FormulaInput refinedInput() {
    FormulaInput input{signalAt, {}};
    input.tf.name = "one ramp";
    input.tf.opacityUnitMm = kCubeMm / 2.0;
    // Beyond the signal's range on both sides: no ray meets a knot.
    input.tf.points = {{.value = -0.1, .color = {0.1, 0.3, 0.9}, .opacity = 0.02},
                       {.value = 1.1, .color = {1.0, 0.6, 0.1}, .opacity = 0.9}};
    return input;
}

VolumeGeometry refinedCube(int edgeVoxels) {
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(edgeVoxels);
    geometry.spacingMm = glm::dvec3(kCubeMm / edgeVoxels);
    geometry.originMm = 0.5 * geometry.spacingMm - 0.5 * kCubeMm;
    return geometry;
}

double voxelCentre(int voxel, int edgeVoxels) {
    return (voxel + 0.5) / edgeVoxels;
}

Volume refinedVolume(const FormulaField& field, int edgeVoxels, VoxelPlace place) {
    Volume volume;
    volume.name = "Marschner-Lobb, one wave";
    volume.type = VoxelType::F32;
    volume.geometry = refinedCube(edgeVoxels);
    const auto edge = static_cast<std::size_t>(edgeVoxels);
    volume.voxels.resize(edge * edge * edge * sizeof(float));
    parallelFor(edgeVoxels, 1, [&](std::int64_t begin, std::int64_t end) {
        for (auto z = static_cast<int>(begin); z < end; ++z) {
            for (int y = 0; y < edgeVoxels; ++y) {
                for (int x = 0; x < edgeVoxels; ++x) {
                    const auto at = [&](int voxel) { return place(voxel, edgeVoxels); };
                    const auto value = static_cast<float>(field({at(x), at(y), at(z)}));
                    const auto index = static_cast<std::size_t>((z * edgeVoxels + y)) * edge + x;
                    std::memcpy(&volume.voxels[index * sizeof value], &value, sizeof value);
                }
            }
        }
    });
    return volume;
}

View refinedView(double fovDegrees) {
    return {viewFromModel(kRefinedCamera, refinedCube(1).boundingSphere()),
            symmetricFrustum(fovDegrees, 1.0), 0.0};
}

std::vector<glm::dvec4> refinedTruth(const FormulaInput& input, int edge) {
    const VolumeGeometry cube = refinedCube(1);
    const RayFrame frame =
        makeRayFrame(refinedView(kRefinedFovDegrees), {0, 0, edge, edge}, cube,
                     {.total = 1, .spacingMm = 2.0 * cube.boundingSphere().radiusMm});
    std::vector<glm::dvec4> picture;
    for (int i = 0; i < edge * edge; ++i) {
        const glm::dvec2 at = glm::dvec2(i % edge, i / edge) + 0.5;
        picture.push_back(integrateFormula(input, rayAt(frame, at), kRefinedPieces));
    }
    return picture;
}

double rmseOf(const std::vector<glm::dvec4>& picture, const std::vector<glm::dvec4>& reference) {
    double squares = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const glm::dvec4 apart = picture[i] - reference[i];
        squares += glm::dot(apart, apart);
    }
    return std::sqrt(squares / (4.0 * static_cast<double>(picture.size())));
}

} // namespace slabcast

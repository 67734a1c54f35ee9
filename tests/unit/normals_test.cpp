#include "core/volume/normals.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/volume/voxel_dispatch.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyInt;

template <class Formula>
Volume volumeOf(glm::ivec3 dims, const Formula& formula) {
    Volume volume;
    volume.type = VoxelType::F64;
    volume.geometry.dims = dims;
    volume.voxels.resize(static_cast<std::size_t>(volume.geometry.voxelCount()) * sizeof(double));
    visitVoxels(volume, [&]<class T>(std::span<T> voxels) {
        std::size_t i = 0;
        for (int z = 0; z < dims.z; ++z) {
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x) {
                    voxels[i++] = static_cast<T>(formula(glm::dvec3(x, y, z)));
                }
            }
        }
    });
    return volume;
}

Texels encoded(const Volume& volume) {
    return encodeTexels(volume, computeStatistics(volume), TexelFormat::R32fExact);
}

double degreesBetween(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b))) * 180.0 /
           std::numbers::pi;
}

/// Half a step in each of three components, of a direction so many steps long.
double roundingDegrees(double steps) {
    return std::asin(std::min(1.0, std::sqrt(0.75) / steps)) * 180.0 / std::numbers::pi;
}

// A plane in patient space has one gradient, whatever the grid's spacing and axes; and away from
// the clamped edge its texels, and what is filtered between them, are that one rounded.
TEST(Normals, OfAPlaneAreItsGradientRounded) {
    const glm::dvec3 gradient(3.0, -2.0, 0.5);
    const glm::dmat3 turned(glm::dvec3(0.6, 0.8, 0.0), glm::dvec3(-0.8, 0.6, 0.0),
                            glm::dvec3(0.0, 0.0, -1.0));
    const glm::dvec3 spacing(0.5, 2.0, 1.25);
    Volume volume = volumeOf({9, 8, 7}, [&](glm::dvec3 voxel) {
        return glm::dot(gradient, turned * (spacing * voxel));
    });
    volume.geometry.spacingMm = spacing;
    volume.geometry.direction = turned;
    for (const double steepest : {4.0, 40.0, 400.0}) {
        const NormalTexels normals =
            bakeNormals(encoded(volume), volume.geometry, steepest, glm::length(gradient) / 2.0);
        const double steps = 127.0 * std::sqrt(glm::length(gradient) / steepest);
        const glm::dvec4 middle = normals.at({0.52, 0.47, 0.5});
        EXPECT_LE(degreesBetween(glm::dvec3(middle), gradient), roundingDegrees(steps));
        const double relative = 0.5 / steps; // of the root
        EXPECT_NEAR(normals.steepnessPerMm(middle), glm::length(gradient),
                    glm::length(gradient) * (2.0 * relative + relative * relative) + 1e-9);
        EXPECT_GT(normals.error.places, 10000);
        EXPECT_GE(normals.error.mostOf95Degrees, normals.error.meanDegrees);
    }
}

PROPERTY(Normals, RoundingTurnsAHundredthOfTheSteepestByAtMostFourDegrees) {
    const glm::dvec3 direction(anyInt(-100, 101), anyInt(-100, 101), anyInt(-100, 101));
    PROPERTY_ASSUME(glm::length(direction) > 0.0);
    const double share = anyInt(1, 101) / 100.0;
    const glm::dvec3 gradient = glm::normalize(direction) * share;
    const Volume volume =
        volumeOf(glm::ivec3(3), [&](glm::dvec3 voxel) { return glm::dot(gradient, voxel); });
    const NormalTexels normals = bakeNormals(encoded(volume), volume.geometry, 1.0, 0.0);
    const glm::dvec3 baked(normals.at(glm::dvec3(0.5)));
    const double degrees = degreesBetween(baked, gradient);
    PROPERTY_ASSERT(degrees <= roundingDegrees(127.0 * std::sqrt(share)) + 1e-4);
    PROPERTY_ASSERT(degrees <= 4.0);
}

TEST(Normals, SteeperThanTheScaleKeepTheirDirection) {
    const Volume volume = volumeOf(glm::ivec3(3), [](glm::dvec3 v) { return 1000.0 * v.y; });
    const NormalTexels normals = bakeNormals(encoded(volume), volume.geometry, 1.0, 0.0);
    EXPECT_EQ(normals.texels[13], glm::i8vec4(0, 127, 0, 127));
    EXPECT_DOUBLE_EQ(normals.steepnessPerMm(normals.at(glm::dvec3(0.5))), 1.0);
}

TEST(Normals, OfConstantDataPointNowhere) {
    const Volume volume = volumeOf(glm::ivec3(4), [](glm::dvec3) { return 5.0; });
    const NormalTexels normals = bakeNormals(encoded(volume), volume.geometry, 1.0, 0.0);
    for (const glm::i8vec4& texel : normals.texels) {
        EXPECT_EQ(texel, glm::i8vec4(0));
    }
    EXPECT_EQ(normals.error.places, 0);
}

// On a ball with an edge of 2 voxels gradients of voxels, filtered, are within a degree of those
// between voxels; an edge that turns within a voxel is not seen so, and the error says it.
TEST(Normals, ErrorTellsSmoothDataFromRough) {
    const auto ball = [](double edge) {
        return volumeOf(glm::ivec3(48), [=](glm::dvec3 v) {
            const double r = glm::length(v - glm::dvec3(23.3, 23.1, 23.8));
            return 1000.0 / (1.0 + std::exp((r - 15.0) / edge));
        });
    };
    const auto errorOf = [](const Volume& volume) {
        return bakeNormals(encoded(volume), volume.geometry, 500.0, 5.0).error;
    };
    const NormalsError smooth = errorOf(ball(1.0));
    const NormalsError rough = errorOf(ball(0.1));
    EXPECT_GT(smooth.places, 1000);
    EXPECT_LT(smooth.meanDegrees, 1.5);
    EXPECT_GT(rough.meanDegrees, 2.0 * smooth.meanDegrees);
}

} // namespace
} // namespace slabcast

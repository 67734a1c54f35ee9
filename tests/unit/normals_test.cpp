#include "core/volume/normals.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/formula_volume.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyInt;
using test::floatTexels;

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
    const VolumeGeometry geometry{.dims = {9, 8, 7}, .spacingMm = spacing, .direction = turned};
    const Texels texels = floatTexels(geometry, [&](glm::ivec3 voxel) {
        return glm::dot(gradient, turned * (spacing * glm::dvec3(voxel)));
    });
    for (const double steepest : {4.0, 40.0, 400.0}) {
        const NormalTexels normals =
            bakeNormals(texels, geometry, steepest, glm::length(gradient) / 2.0);
        const double steps = 127.0 * std::sqrt(glm::length(gradient) / steepest);
        const glm::dvec4 middle = normals.at({0.52, 0.47, 0.5});
        EXPECT_LE(degreesBetween(glm::dvec3(middle), gradient), roundingDegrees(steps));
        const double relative = 0.5 / steps; // of the root
        EXPECT_NEAR(normals.steepnessPerMm(middle), glm::length(gradient),
                    glm::length(gradient) * (2.0 * relative + relative * relative) + 1e-9);
        EXPECT_GT(normals.error.places, 10000);
        EXPECT_GE(normals.error.percentile95Degrees, normals.error.meanDegrees);
    }
}

PROPERTY(Normals, RoundingTurnsAHundredthOfTheSteepestByAtMostFourDegrees) {
    const glm::dvec3 direction(anyInt(-100, 101), anyInt(-100, 101), anyInt(-100, 101));
    PROPERTY_ASSUME(glm::length(direction) > 0.0);
    const double share = anyInt(1, 101) / 100.0;
    const glm::dvec3 gradient = glm::normalize(direction) * share;
    const VolumeGeometry geometry{.dims = glm::ivec3(3)};
    const Texels texels = floatTexels(
        geometry, [&](glm::ivec3 voxel) { return glm::dot(gradient, glm::dvec3(voxel)); });
    const NormalTexels normals = bakeNormals(texels, geometry, 1.0, 0.0);
    const glm::dvec3 baked(normals.at(glm::dvec3(0.5)));
    const double degrees = degreesBetween(baked, gradient);
    PROPERTY_ASSERT(degrees <= roundingDegrees(127.0 * std::sqrt(share)) + 1e-4);
    PROPERTY_ASSERT(degrees <= 4.0);
}

TEST(Normals, SteeperThanTheScaleKeepTheirDirection) {
    const VolumeGeometry geometry{.dims = glm::ivec3(3)};
    const Texels texels = floatTexels(geometry, [](glm::ivec3 v) { return 1000.0 * v.y; });
    const NormalTexels normals = bakeNormals(texels, geometry, 1.0, 0.0);
    EXPECT_EQ(normals.texels[13], glm::i8vec4(0, 127, 0, 127));
    EXPECT_DOUBLE_EQ(normals.steepnessPerMm(normals.at(glm::dvec3(0.5))), 1.0);
}

TEST(Normals, OfConstantDataPointNowhere) {
    const VolumeGeometry geometry{.dims = glm::ivec3(4)};
    const Texels texels = floatTexels(geometry, [](glm::ivec3) { return 5.0; });
    const NormalTexels normals = bakeNormals(texels, geometry, 1.0, 0.0);
    for (const glm::i8vec4& texel : normals.texels) {
        EXPECT_EQ(texel, glm::i8vec4(0));
    }
    EXPECT_EQ(normals.error.places, 0);
}

// On a ball with a soft edge the two gradients agree but for rounding, less than a degree on
// average. An edge that turns within a voxel they see differently, and the error says so.
TEST(Normals, ErrorTellsSmoothDataFromRough) {
    const auto errorOf = [](double edge) {
        const VolumeGeometry geometry{.dims = glm::ivec3(48)};
        const Texels ball = floatTexels(geometry, [=](glm::ivec3 v) {
            const double r = glm::length(glm::dvec3(v) - glm::dvec3(23.3, 23.1, 23.8));
            return 1000.0 / (1.0 + std::exp((r - 15.0) / edge));
        });
        return bakeNormals(ball, geometry, 500.0, 5.0).error;
    };
    const NormalsError smooth = errorOf(2.0);
    EXPECT_GT(smooth.places, 1000);
    EXPECT_LT(smooth.meanDegrees, 1.0);
    EXPECT_GT(errorOf(0.1).meanDegrees, smooth.meanDegrees * 4.0);
}

} // namespace
} // namespace slabcast

#include "core/skip/proximity_cloud.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/property.h"
#include "tests/support/skip_blocks.h"

namespace slabcast {
namespace {

using test::anyBits;
using test::anyElement;
using test::anyInt;
using test::bandTable;
using test::constantScene;
using test::forBox;
using test::indexOf;
using test::occupiedByTheWords;
using test::randomEdge;
using test::randomScene;
using test::SkipScene;

/// Distance in quanta from a block to the nearest occupied one, all pairs, box to box. Negative
/// where none is.
double nearestInQuanta(glm::ivec3 block, glm::ivec3 blocks,
                       const std::vector<std::uint8_t>& occupied, const VolumeGeometry& geometry,
                       int edge) {
    const glm::dvec3 blockEdge = geometry.spacingMm * double(edge) / geometry.smallestVoxelEdgeMm();
    double nearest = -1.0;
    forBox(glm::ivec3(0), blocks, [&](glm::ivec3 other) {
        if (occupied[indexOf(other, blocks)] != 0) {
            const glm::ivec3 gap = glm::max(glm::abs(block - other) - 1, 0);
            const double distance = glm::length(glm::dvec3(gap) * blockEdge);
            nearest = nearest < 0.0 ? distance : std::min(nearest, distance);
        }
    });
    return nearest;
}

FreeLengths built(const SkipScene& scene, int edge) {
    const auto cloud = buildProximityCloud(scene.visibility(), scene.geometry, edge);
    EXPECT_TRUE(cloud.has_value());
    return *cloud;
}

PROPERTY(ProximityCloud, OccupiesTheBlocksThatVisibleCellsMeet) {
    const SkipScene scene = randomScene(20);
    const int edge = randomEdge();
    const std::vector<std::uint8_t> expected = occupiedByTheWords(scene, scene.visibility(), edge);
    const FreeLengths cloud = built(scene, edge);
    forBox(glm::ivec3(0), cloud.blocks, [&](glm::ivec3 block) {
        const bool occupied = expected[indexOf(block, cloud.blocks)] != 0;
        PROPERTY_ASSERT((cloud.counts[indexOf(block, cloud.blocks)] == 0) == occupied);
    });
    PROPERTY_ASSERT(cloud.occupiedBlocks == std::count(expected.begin(), expected.end(), 1));
}

/// Checks every free block against all pairs. `loss`: the part of a length that rounding may take.
void checkLengths(const SkipScene& scene, int edge, double loss) {
    const FreeLengths cloud = built(scene, edge);
    const std::vector<std::uint8_t> occupied = occupiedByTheWords(scene, scene.visibility(), edge);
    PROPERTY_ASSERT(cloud.quantumMm == scene.geometry.smallestVoxelEdgeMm());
    forBox(glm::ivec3(0), cloud.blocks, [&](glm::ivec3 block) {
        const int stored = cloud.counts[indexOf(block, cloud.blocks)];
        const double quanta = nearestInQuanta(block, cloud.blocks, occupied, scene.geometry, edge);
        if (quanta < 0.0) {
            PROPERTY_ASSERT(stored == 255);
        } else if (stored > 0) {
            PROPERTY_ASSERT(stored <= std::min(255, 1 + int(quanta * (1.0 + 1.1e-5))));
            PROPERTY_ASSERT(stored >= std::min(255, 1 + int(quanta * (1.0 - loss))));
        }
    });
}

PROPERTY(ProximityCloud, LengthsAreExactForDyadicSpacing) {
    SkipScene scene = randomScene(16);
    const auto ratio = [] { return anyElement(1.0, 1.25, 2.0, 3.0625, 40.0); };
    scene.geometry.spacingMm = 0.5 * glm::dvec3(ratio(), ratio(), ratio());
    scene.geometry.spacingMm[anyInt(0, 3)] = 0.5;
    checkLengths(scene, randomEdge(), 0.0);
}

PROPERTY(ProximityCloud, LengthsAreLowerBoundsForAnySpacing) {
    SkipScene scene = randomScene(16);
    const auto spacing = [] { return anyInt(1, 500); };
    scene.geometry.spacingMm = glm::dvec3(spacing(), spacing(), spacing()) / 97.0;
    checkLengths(scene, randomEdge(), 1.0 / 256.0);
}

/// Random free blocks, random points of them, random directions: what lies nearer than the stored
/// length must be transparent, also a voxel to the side of it (the margin) and outside the box
/// (clamped).
void checkSamples(const SkipScene& scene, const FreeLengths& cloud, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> normal;
    const auto vec = [&](auto& distribution) {
        return glm::dvec3(distribution(random), distribution(random), distribution(random));
    };
    glm::dmat3 mmFromVoxel = scene.geometry.direction;
    for (int axis = 0; axis < 3; ++axis) {
        mmFromVoxel[axis] *= scene.geometry.spacingMm[axis];
    }
    const glm::dmat3 voxelFromMm = glm::inverse(mmFromVoxel);
    const glm::dvec3 dims(scene.geometry.dims);
    for (int i = 0; i < 500; ++i) {
        const glm::ivec3 block =
            glm::min(glm::ivec3(vec(unit) * glm::dvec3(cloud.blocks)), cloud.blocks - 1);
        const int stored = cloud.counts[indexOf(block, cloud.blocks)];
        if (stored == 0) {
            continue;
        }
        const glm::dvec3 start =
            glm::min((glm::dvec3(block) + vec(unit)) * double(cloud.blockEdgeVoxels), dims);
        const double free = (stored - 1) * cloud.quantumMm;
        const glm::dvec3 step = voxelFromMm * glm::normalize(vec(normal));
        for (const double share : {0.0, unit(random), 0.999}) {
            const glm::dvec3 point = start + step * (free * share);
            const glm::dvec3 beside = point + (2.0 * vec(unit) - 1.0) * 0.99;
            for (const glm::dvec3 p : {point, beside, glm::clamp(point, glm::dvec3(0.0), dims)}) {
                PROPERTY_ASSERT(lookUp(scene.table, test::fieldAt(scene, p)).a == 0.0);
            }
        }
    }
}

PROPERTY(ProximityCloud, NothingVisibleLiesWithinTheFreeLength) {
    const unsigned seed = anyBits();
    SkipScene scene = randomScene(28);
    const auto spacing = [] { return anyInt(30, 300); };
    scene.geometry.spacingMm = glm::dvec3(spacing(), spacing(), spacing()) / 97.0;
    const auto shear = [] { return anyInt(-70, 70); };
    const glm::dvec3 tilt = glm::dvec3(shear(), shear(), shear()) / 100.0;
    scene.geometry.direction =
        glm::dmat3(glm::dvec3(1.0, 0.0, 0.0), glm::normalize(glm::dvec3(tilt.x, 1.0, 0.0)),
                   glm::normalize(glm::dvec3(tilt.y, tilt.z, 1.0)));
    checkSamples(scene, built(scene, randomEdge()), seed);
}

TEST(ProximityCloud, OneVoxelInALongRow) {
    SkipScene scene = constantScene({400, 1, 1}, 0, bandTable(256, 200, 255));
    scene.code({0, 0, 0}) = 255; // visible from 0 to 1.5, met by blocks up to 2.5: blocks 0, 1, 2
    const FreeLengths cloud = built(scene, 1);
    for (int x = 0; x < 400; ++x) {
        const int gap = x - 2 - 1;
        EXPECT_EQ(cloud.counts[x], x <= 2 ? 0 : std::min(255, 1 + gap)) << x;
    }
    EXPECT_EQ(cloud.occupiedBlocks, 3);
}

TEST(ProximityCloud, RatiosThatRoundBelowAWholeNumberAreMeantAsIt) {
    SkipScene scene = constantScene({1, 1, 40}, 0, bandTable(256, 200, 255));
    scene.code({0, 0, 0}) = 255;
    scene.geometry.spacingMm = {0.2, 0.2, 0.6};
    const FreeLengths cloud = built(scene, 4);
    EXPECT_EQ(cloud.counts, (std::vector<std::uint8_t>{0, 1, 13, 25, 37, 49, 61, 73, 85, 97}));
}

TEST(ProximityCloud, ShearShortensLengthsByTheSmallestSingularValue) {
    SkipScene scene = constantScene({64, 1, 1}, 0, bandTable(256, 200, 255));
    scene.code({0, 0, 0}) = 255;
    const double cosine = 0.6; // of the angle between x and y: sigma_min = sqrt(1 - 0.6)
    scene.geometry.direction[1] = glm::dvec3(cosine, std::sqrt(1.0 - cosine * cosine), 0.0);
    const FreeLengths cloud = built(scene, 4);
    for (int b = 1; b < 16; ++b) {
        EXPECT_EQ(cloud.counts[b], 1 + int(std::sqrt(0.4) * 4.0 * (b - 1))) << b;
    }
}

TEST(ProximityCloud, RotatedAxesCostNothing) {
    SkipScene scene = constantScene({40, 1, 1}, 0, bandTable(256, 200, 255));
    scene.code({0, 0, 0}) = 255;
    const FreeLengths straight = built(scene, 4);
    // A rotation as a file holds it, six digits each.
    scene.geometry.direction = glm::dmat3(0.353553, 0.612372, -0.707107, -0.573223, 0.739199,
                                          0.353553, 0.739199, 0.280330, 0.612372);
    EXPECT_EQ(built(scene, 4).counts, straight.counts);
}

TEST(ProximityCloud, NothingVisibleIsFreeEverywhere) {
    const SkipScene scene = constantScene({9, 7, 5}, 0, bandTable(256, 200, 255));
    const FreeLengths cloud = built(scene, 4);
    EXPECT_EQ(cloud.blocks, glm::ivec3(3, 2, 2));
    EXPECT_EQ(cloud.counts, std::vector<std::uint8_t>(12, 255));
    EXPECT_EQ(cloud.occupiedBlocks, 0);
}

TEST(ProximityCloud, RefusesOtherBlockEdges) {
    const SkipScene scene = constantScene({9, 7, 5}, 0, bandTable(256, 200, 255));
    for (const int edge : {-4, 0, 3, 16}) {
        const auto cloud = buildProximityCloud(scene.visibility(), scene.geometry, edge);
        ASSERT_FALSE(cloud.has_value()) << edge;
        EXPECT_EQ(cloud.error().code, ErrorCode::InvalidArgument);
    }
}

TEST(ProximityCloud, StopsWhenCancelled) {
    const SkipScene scene = constantScene({64, 64, 64}, 255, bandTable(256, 200, 255));
    const CancelToken cancel(true);
    const auto cloud = buildProximityCloud(scene.visibility(), scene.geometry, 4, &cancel);
    ASSERT_FALSE(cloud.has_value());
    EXPECT_EQ(cloud.error().code, ErrorCode::Internal);
}

TEST(ProximityCloud, CutsTheLastBlockOfAnAxis) {
    SkipScene scene = constantScene({21, 1, 1}, 0, bandTable(256, 200, 255));
    scene.code({20, 0, 0}) = 255; // visible from 19.5 to 21: the last two blocks of six
    EXPECT_EQ(built(scene, 4).counts, (std::vector<std::uint8_t>{13, 9, 5, 1, 0, 0}));
}

} // namespace
} // namespace slabcast

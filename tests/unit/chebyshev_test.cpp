#include "core/skip/chebyshev.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "core/skip/blocks.h"
#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"
#include "tests/support/property.h"
#include "tests/support/skip_blocks.h"

namespace slabcast {
namespace {

using test::anyBits;
using test::anyElement;
using test::anyInt;
using test::anyInts;
using test::bandTable;
using test::chebyshevByTheWords;
using test::constantScene;
using test::intsInRange;
using test::occupiedByTheWords;
using test::randomEdge;
using test::randomScene;
using test::SkipScene;

FreeLengths built(Result<FreeLengths> result) {
    EXPECT_TRUE(result.has_value());
    return *result;
}

std::int64_t sites(const std::vector<std::uint8_t>& occupied) {
    return std::count(occupied.begin(), occupied.end(), 1);
}

PROPERTY(Chebyshev, CountsBlocksToTheNearestOccupiedOne) {
    const SkipScene scene = randomScene(20);
    const int edge = randomEdge();
    const CellVisibility visibility = scene.visibility();
    const auto occupied = occupiedByTheWords(scene, visibility, edge);
    const FreeLengths map = built(buildChebyshev(visibility, edge));
    PROPERTY_ASSERT(map.blocks == (scene.geometry.dims + edge - 1) / edge);
    PROPERTY_ASSERT(map.blockEdgeVoxels == edge);
    PROPERTY_ASSERT(map.quantumMm == 0.0);
    PROPERTY_ASSERT(map.occupiedBlocks == sites(occupied));
    PROPERTY_ASSERT(map.counts == chebyshevByTheWords(occupied, map.blocks));
}

PROPERTY(Blocks, AreOccupiedOrFree) {
    const SkipScene scene = randomScene(20);
    const int edge = anyElement(1, 2, 4, 8, 16, 32);
    const CellVisibility visibility = scene.visibility();
    std::vector<std::uint8_t> expected = occupiedByTheWords(scene, visibility, edge);
    const std::int64_t occupied = sites(expected);
    for (std::uint8_t& block : expected) {
        block = block == 0;
    }
    const FreeLengths map = built(buildBlocks(visibility, edge));
    PROPERTY_ASSERT(map.counts == expected);
    PROPERTY_ASSERT(map.occupiedBlocks == occupied);
    PROPERTY_ASSERT(map.quantumMm == 0.0);
}

/// Grids long enough to reach 255 along any axis, and thin ones.
PROPERTY(ChebyshevTransform, IsTheDistanceBetweenAllPairs) {
    glm::ivec3 size(anyInt(1, 12), anyInt(1, 12), anyInt(1, 12));
    if (anyInt(0, 3) == 0) {
        size = glm::ivec3(anyInt(1, 3), anyInt(1, 3), 1);
        size[anyInt(0, 3)] = anyInt(1, 600);
    }
    const int count = size.x * size.y * size.z;
    std::vector<std::uint8_t> marks(count);
    for (const int site : anyInts(intsInRange(0, std::max(1, count)))) {
        marks[site] = 1;
    }
    std::vector<std::uint8_t> bytes(count);
    std::transform(marks.begin(), marks.end(), bytes.begin(),
                   [](std::uint8_t mark) { return mark != 0 ? 0 : 255; });
    const ChebyshevTransform transform{size, bytes.data()};
    transform.withinSlices(0, size.z);
    transform.upwards(0, size.z);
    transform.downwards(0, size.z);
    PROPERTY_ASSERT(bytes == chebyshevByTheWords(marks, size));
}

/// Random free blocks, random points of the box that a block makes when it is grown by one block
/// less than is stored: they must be transparent, also less than a voxel beside it (the margin),
/// also outside the volume (clamped).
void checkSamples(const SkipScene& scene, const FreeLengths& map, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto vec = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < 500; ++i) {
        const glm::ivec3 block =
            glm::min(glm::ivec3(vec() * glm::dvec3(map.blocks)), map.blocks - 1);
        const int stored = map.counts[test::indexOf(block, map.blocks)];
        if (stored == 0) {
            continue;
        }
        const glm::dvec3 low(block - (stored - 1));
        const glm::dvec3 high(block + stored);
        const glm::dvec3 inVolume = glm::dvec3(scene.geometry.dims);
        const glm::dvec3 anywhere = glm::mix(low, high, vec()) * double(map.blockEdgeVoxels);
        const glm::dvec3 inside = glm::mix(glm::max(low * double(map.blockEdgeVoxels), 0.0),
                                           glm::min(high * double(map.blockEdgeVoxels), inVolume),
                                           glm::floor(vec() * 3.0) / 2.0); // corners and middles
        for (const glm::dvec3 p : {anywhere, inside, inside + (2.0 * vec() - 1.0) * 0.99}) {
            PROPERTY_ASSERT(lookUp(scene.table, test::fieldAt(scene, p)).a == 0.0);
        }
    }
}

PROPERTY(Chebyshev, NothingVisibleLiesInTheGrownBox) {
    const unsigned seed = anyBits();
    const SkipScene scene = randomScene(28);
    checkSamples(scene, built(buildChebyshev(scene.visibility(), randomEdge())), seed);
}

PROPERTY(Blocks, NothingVisibleLiesInAFreeBlock) {
    const unsigned seed = anyBits();
    const SkipScene scene = randomScene(28);
    checkSamples(scene, built(buildBlocks(scene.visibility(), randomEdge())), seed);
}

/// Runs stages in random pieces, those of a stage that has no order in a random order.
void runInPieces(const BuildStages& stages, unsigned seed) {
    std::mt19937 random(seed);
    for (const BuildStage& stage : stages) {
        std::vector<std::pair<std::int64_t, std::int64_t>> pieces;
        for (std::int64_t begin = 0; begin < stage.items;) {
            const std::int64_t end = std::min<std::int64_t>(stage.items, begin + 1 + random() % 3);
            pieces.emplace_back(begin, end);
            begin = end;
        }
        if (!stage.inOrder) {
            std::shuffle(pieces.begin(), pieces.end(), random);
        }
        for (const auto& [begin, end] : pieces) {
            stage.run(begin, end);
        }
    }
}

PROPERTY(BuildStages, InPiecesGiveWhatOneCallGives) {
    const unsigned seed = anyBits();
    SkipScene scene = randomScene(28);
    const auto spacing = [] { return anyInt(30, 300); };
    scene.geometry.spacingMm = glm::dvec3(spacing(), spacing(), spacing()) / 97.0;
    const int edge = randomEdge();
    const CellVisibility visibility = scene.visibility();
    const auto ranges = blockRanges(scene.codes, edge);
    PROPERTY_ASSERT(ranges.has_value());
    FreeLengths result;
    runInPieces(blocksStages(*ranges, edge, visibility, result), seed);
    PROPERTY_ASSERT(result == built(buildBlocks(visibility, edge)));
    runInPieces(chebyshevStages(*ranges, edge, visibility, result), seed);
    PROPERTY_ASSERT(result == built(buildChebyshev(visibility, edge)));
    runInPieces(proximityStages(*ranges, edge, visibility, scene.geometry, result), seed);
    PROPERTY_ASSERT(result == built(buildProximityCloud(visibility, scene.geometry, edge)));
}

TEST(BuildStages, StopAtTheNextItemWhenCancelled) {
    for (const bool inOrder : {false, true}) {
        CancelToken cancel(false);
        std::atomic<int> begun{0};
        const auto run = [&](std::int64_t, std::int64_t) {
            ++begun;
            cancel = true;
        };
        const Result<void> result = runStages({{1000, run, inOrder}, {1, run}}, &cancel);
        ASSERT_FALSE(result.has_value());
        EXPECT_EQ(result.error().code, ErrorCode::Internal);
        EXPECT_LT(begun, inOrder ? 2 : 1000); // threads may have begun one each
    }
}

TEST(BuildStages, InOrderComeOneByOne) {
    std::vector<std::int64_t> items;
    const auto note = [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            items.push_back(i);
        }
    };
    ASSERT_TRUE(runStages({{100, note, true}}).has_value());
    std::vector<std::int64_t> expected(100);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(items, expected);
}

TEST(Chebyshev, OneVoxelInALongRow) {
    SkipScene scene = constantScene({400, 1, 1}, 0, bandTable(256, 200, 255));
    scene.code({0, 0, 0}) = 255; // visible from 0 to 1.5, met by blocks up to 2.5: blocks 0, 1, 2
    const FreeLengths map = built(buildChebyshev(scene.visibility(), 1));
    for (int x = 0; x < 400; ++x) {
        EXPECT_EQ(map.counts[x], std::clamp(x - 2, 0, 255)) << x;
    }
    EXPECT_EQ(map.occupiedBlocks, 3);
}

TEST(Chebyshev, NothingVisibleIsFreeEverywhere) {
    const SkipScene scene = constantScene({9, 7, 5}, 0, bandTable(256, 200, 255));
    const FreeLengths map = built(buildChebyshev(scene.visibility(), 4));
    EXPECT_EQ(map.blocks, glm::ivec3(3, 2, 2));
    EXPECT_EQ(map.counts, std::vector<std::uint8_t>(12, 255));
    EXPECT_EQ(map.occupiedBlocks, 0);
    const FreeLengths blocks = built(buildBlocks(scene.visibility(), 4));
    EXPECT_EQ(blocks.counts, std::vector<std::uint8_t>(12, 1)); // nothing is known beyond
}

TEST(Chebyshev, RefusesOtherBlockEdges) {
    const SkipScene scene = constantScene({9, 7, 5}, 0, bandTable(256, 200, 255));
    const CellVisibility visibility = scene.visibility();
    for (const int edge : {-4, 0, 3, 64}) {
        for (const auto& result :
             {buildChebyshev(visibility, edge), buildBlocks(visibility, edge)}) {
            ASSERT_FALSE(result.has_value()) << edge;
            EXPECT_EQ(result.error().code, ErrorCode::InvalidArgument);
        }
    }
}

TEST(Chebyshev, StopsWhenCancelled) {
    const SkipScene scene = constantScene({64, 64, 64}, 255, bandTable(256, 200, 255));
    const CancelToken cancel(true);
    const CellVisibility visibility = scene.visibility();
    for (const auto& result :
         {buildChebyshev(visibility, 4, &cancel), buildBlocks(visibility, 4, &cancel)}) {
        ASSERT_FALSE(result.has_value());
        EXPECT_EQ(result.error().code, ErrorCode::Internal);
    }
}

} // namespace
} // namespace slabcast

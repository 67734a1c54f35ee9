#include "core/skip/octree.h"

#include <random>

#include <gtest/gtest.h>

#include "core/draw/visible_boxes.h"
#include "core/skip/bitfield_octree.h"
#include "core/skip/boolean_octree.h"
#include "core/skip/minmax_octree.h"
#include "tests/support/octree_look.h"
#include "tests/support/property.h"
#include "tests/support/skip_blocks.h"

namespace slabcast {
namespace {

using test::anyBits;
using test::anyBool;
using test::anyElement;
using test::anyInt;
using test::anyPairs;
using test::forBox;
using test::intsInRange;
using test::intsOf;
using test::lookAt;
using test::OctreeLook;
using test::SkipScene;

/// Up to three visible bands, of values that voxels have or that lie between, in a table with a
/// texel per value, or more or fewer.
TransferTable randomTable() {
    const int size = anyElement(256, 256, 64, 1021);
    TransferTable table{0.0, 255.0, std::vector<glm::vec4>(size, glm::vec4(0.0F))};
    const auto bands = anyPairs(3, intsInRange(0, size), intsOf({0, 1, 5, 100}));
    for (const auto& [first, length] : bands) {
        for (int k = first; k <= std::min(size - 1, first + length); ++k) {
            table.texels[k] = glm::vec4(1.0F, 1.0F, 1.0F, 0.5F);
        }
    }
    return table;
}

SkipScene randomScene(int largestDim) {
    return test::oddVoxels(largestDim, anyInt(0, 256), randomTable());
}

SkipOptions randomOptions() {
    SkipOptions options;
    options.blockEdgeVoxels = anyElement(2, 4, 8, 16);
    options.bits = anyElement(8, 16, 32, 64, 128);
    options.initialLevel = anyInt(0, 4);
    return options;
}

ValueBins evenBins(const SkipScene& scene, int count) {
    return valueBins(scene.codes, codeRange(scene.codes), count, false);
}

ValueBins randomBins(const SkipScene& scene, int count) {
    std::optional<std::array<double, 2>> trimmed;
    if (anyBool()) {
        const int low = anyInt(0, 200);
        trimmed = {double(low), double(low + anyInt(1, 56))};
    }
    return valueBins(scene.codes, codeRange(scene.codes), count, anyBool(), trimmed);
}

/// Octrees that know nothing of the scene's TF, but for the Boolean one.
struct Octrees {
    Octree boolean;
    Octree minMax;
    BitfieldOctree bitfield;
};

Octrees built(const SkipScene& scene, const SkipOptions& options, ValueBins bins) {
    const auto boolean = buildBooleanOctree(scene.visibility(), options);
    const auto minMax = buildMinMaxOctree(scene.codes, options);
    const auto bitfield = buildBitfieldOctree(scene.codes, std::move(bins), options);
    EXPECT_TRUE(boolean && minMax && bitfield);
    return {*boolean, *minMax, *bitfield};
}

Octrees built(const SkipScene& scene, const SkipOptions& options) {
    return built(scene, options, randomBins(scene, options.bits));
}

/// Calls visit(octree, test) with each octree and what the scene's TF makes of it.
template <class Visit>
void forEachOctree(const Octrees& octrees, const CellVisibility& visibility, Visit visit) {
    visit(octrees.boolean, booleanNodeTest());
    visit(octrees.minMax, minMaxNodeTest(visibility));
    visit(octrees.bitfield.octree, bitfieldNodeTest(octrees.bitfield.bins, visibility));
}

/// What the cells say that meet a node grown by one voxel, each looked at by itself.
struct Contents {
    bool visible = false;
    std::uint32_t least = 65535;
    std::uint32_t greatest = 0;
    std::array<std::uint32_t, 4> bits{};
};

/// All cells against all nodes of one edge.
std::vector<Contents> contentsByTheWords(const SkipScene& scene, const ValueBins& bins, int edge) {
    const glm::ivec3 nodes = blocksOf(scene.geometry.dims, edge);
    const CellVisibility visibility = scene.visibility();
    std::vector<Contents> contents(std::size_t(nodes.x) * nodes.y * nodes.z);
    Contents cell;
    const auto lookAtCell = [&](std::uint16_t low, std::uint16_t high) {
        cell = {visibility.visible(low, high), low, high, {}};
        for (int bin = bins.binOfCode[low]; bin <= bins.binOfCode[high]; ++bin) {
            cell.bits[bin / 32] |= 1U << (bin % 32);
        }
        return true;
    };
    test::forBlocksThatCellsMeet(scene, edge, lookAtCell, [&](std::size_t node) {
        Contents& c = contents[node];
        c.visible = c.visible || cell.visible;
        c.least = std::min(c.least, cell.least);
        c.greatest = std::max(c.greatest, cell.greatest);
        for (int w = 0; w < 4; ++w) {
            c.bits[w] |= cell.bits[w];
        }
    });
    return contents;
}

/// The same as a level of an octree.
OctreeLevel levelByTheWords(const Octree& octree, glm::ivec3 dims, int edge,
                            const std::vector<Contents>& contents) {
    OctreeLevel level{blocksOf(dims, edge), {}};
    for (const Contents& c : contents) {
        switch (octree.content) {
        case NodeContent::Occupied:
            level.words.push_back(c.visible);
            break;
        case NodeContent::Range:
            level.words.push_back(c.least | c.greatest << 16);
            break;
        case NodeContent::Bits:
            level.words.insert(level.words.end(), c.bits.begin(),
                               c.bits.begin() + octree.wordsPerNode());
        }
    }
    return level;
}

// Many small cases: ten times as many as is usual.

PROPERTY_TIMES(10, Octree, EveryLevelIsWhatItsCellsSay) {
    const SkipScene scene = randomScene(12);
    const SkipOptions options = randomOptions();
    const Octrees octrees = built(scene, options);
    const glm::ivec3 dims = scene.geometry.dims;
    for (int k = 0; k <= octrees.minMax.coarsest(); ++k) {
        const int edge = options.blockEdgeVoxels << k;
        const auto contents = contentsByTheWords(scene, octrees.bitfield.bins, edge);
        forEachOctree(octrees, scene.visibility(), [&](const Octree& octree, const NodeTest&) {
            PROPERTY_ASSERT(octree.leafEdgeVoxels == options.blockEdgeVoxels);
            PROPERTY_ASSERT(octree.coarsest() == octrees.minMax.coarsest());
            PROPERTY_ASSERT(octree.levels[k] == levelByTheWords(octree, dims, edge, contents));
        });
    }
}

/// Random points in a node and up to half a voxel around it.
void checkShowsNothing(const SkipScene& scene, int edge, glm::ivec3 node, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const glm::dvec3 low = glm::dvec3(node * edge) - 0.5;
    const glm::dvec3 high = glm::dvec3(glm::min((node + 1) * edge, scene.geometry.dims)) + 0.5;
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 at(unit(random), unit(random), unit(random));
        PROPERTY_ASSERT(lookUp(scene.table, test::fieldAt(scene, glm::mix(low, high, at))).a ==
                        0.0);
    }
}

/// Points in the free ones of some nodes, and cells in all.
void checkFreeNodes(const SkipScene& scene, const Octree& octree, const NodeTest& test,
                    const Octree& visibleCells, std::mt19937& random) {
    for (int k = 0; k <= octree.coarsest(); ++k) {
        const glm::ivec3 nodes = octree.levels[k].nodes;
        forBox(glm::ivec3(0), nodes, [&](glm::ivec3 node) {
            PROPERTY_ASSERT(!isFree(octree, octree.node(k, node), test) ||
                            *visibleCells.node(k, node) == 0);
        });
        for (int i = 0; i < 4; ++i) {
            const glm::ivec3 node(random() % nodes.x, random() % nodes.y, random() % nodes.z);
            if (isFree(octree, octree.node(k, node), test)) {
                checkShowsNothing(scene, octree.leafEdgeVoxels << k, node, random);
            }
        }
    }
}

PROPERTY_TIMES(10, Octree, FreeNodesShowNothing) {
    SkipScene scene = randomScene(20);
    std::mt19937 random(anyBits());
    const Octrees octrees = built(scene, randomOptions());
    forEachOctree(octrees, scene.visibility(), [&](const Octree& octree, const NodeTest& test) {
        checkFreeNodes(scene, octree, test, octrees.boolean, random);
    });
    // Another TF: the octrees that know nothing of the first go on as they are.
    scene.table = randomTable();
    const CellVisibility other = scene.visibility();
    const Octree cells = booleanOctree(octrees.minMax, other);
    checkFreeNodes(scene, octrees.minMax, minMaxNodeTest(other), cells, random);
    checkFreeNodes(scene, octrees.bitfield.octree, bitfieldNodeTest(octrees.bitfield.bins, other),
                   cells, random);
}

PROPERTY_TIMES(10, Octree, VisibleNodesAreThoseThatAreNotFree) {
    const SkipScene scene = randomScene(28);
    const Octrees octrees = built(scene, randomOptions());
    forEachOctree(octrees, scene.visibility(), [](const Octree& octree, const NodeTest& test) {
        for (int k = 0; k <= octree.coarsest(); ++k) {
            std::vector<glm::ivec3> found = visibleNodes(octree, test, k);
            std::size_t expected = 0;
            forBox(glm::ivec3(0), octree.levels[k].nodes, [&](glm::ivec3 node) {
                if (!isFree(octree, octree.node(k, node), test)) {
                    ++expected;
                    PROPERTY_ASSERT(std::find(found.begin(), found.end(), node) != found.end());
                }
            });
            PROPERTY_ASSERT(found.size() == expected);
        }
        PROPERTY_ASSERT(visibleLeaves(octree, test) ==
                        std::int64_t(visibleNodes(octree, test, 0).size()));
    });
}

/// With a texel per value, so that no value is visible between two codes alone: of two bins around
/// such a one, more bits may mark the other.
PROPERTY_TIMES(10, Octree, MoreBitsVisitNoMoreLeaves) {
    SkipScene scene = randomScene(28);
    if (scene.table.texels.size() != 256) {
        scene.table = test::bandTable(256, 100, 120);
    }
    const CellVisibility visibility = scene.visibility();
    SkipOptions options = randomOptions();
    std::int64_t fewest = std::int64_t(scene.codes.codes.size());
    for (const int bits : {8, 16, 32, 64, 128}) {
        options.bits = bits;
        const Octrees octrees = built(scene, options, evenBins(scene, bits));
        const auto& [octree, bins] = octrees.bitfield;
        const std::int64_t leaves = visibleLeaves(octree, bitfieldNodeTest(bins, visibility));
        PROPERTY_ASSERT(leaves <= fewest);
        PROPERTY_ASSERT(leaves >= visibleLeaves(octrees.boolean, booleanNodeTest()));
        fewest = leaves;
    }
}

/// A TF without a gap is what its range says of it.
PROPERTY_TIMES(10, Octree, OneRangeOfVisibleValuesIsExact) {
    SkipScene scene = randomScene(20);
    const int first = anyInt(0, 256);
    scene.table = test::bandTable(256, first, std::min(255, first + anyInt(0, 100)));
    const Octrees octrees = built(scene, randomOptions());
    PROPERTY_ASSERT(visibleLeaves(octrees.minMax, minMaxNodeTest(scene.visibility())) ==
                    visibleLeaves(octrees.boolean, booleanNodeTest()));
}

/// From any level looks end at a free node or the leaf, top-down at the largest one, and go on as
/// the traversal says.
PROPERTY_TIMES(10, Octree, LooksEndAtAFreeNodeOrTheLeaf) {
    const SkipScene scene = randomScene(28);
    SkipOptions options = randomOptions();
    options.blockEdgeVoxels = 2;
    const Octrees octrees = built(scene, options);
    std::mt19937 random(anyBits());
    forEachOctree(octrees, scene.visibility(), [&](const Octree& octree, const NodeTest& test) {
        const auto freeAt = [&](int level, glm::ivec3 leaf) {
            return isFree(octree, octree.node(level, leaf >> level), test);
        };
        for (int i = 0; i < 20; ++i) {
            const glm::ivec3 leaves = octree.levels[0].nodes;
            const glm::ivec3 leaf(random() % leaves.x, random() % leaves.y, random() % leaves.z);
            for (const Traversal traversal : {Traversal::Bidirectional, Traversal::TopDown}) {
                const bool topDown = traversal == Traversal::TopDown;
                const int from = topDown ? octree.coarsest() : int(random() % octree.levels.size());
                int largest = from;
                while (largest >= 0 && !freeAt(largest, leaf)) {
                    --largest;
                }
                OctreeLook look = lookAt(octree, test, leaf, traversal, from);
                int looks = 1;
                for (; look.again; ++looks) {
                    look = lookAt(octree, test, leaf, traversal, look.nextLevel);
                }
                const int level = std::max(largest, 0);
                PROPERTY_ASSERT(look.level == level);
                PROPERTY_ASSERT(look.free == (largest >= 0));
                PROPERTY_ASSERT(looks == from - level + 1);
                const int up = std::min(level + (look.free ? 1 : 0), octree.coarsest());
                PROPERTY_ASSERT(look.nextLevel == (topDown ? octree.coarsest() : up));
            }
        }
    });
}

PROPERTY_TIMES(10, Octree, BoxesAreThoseOfTheOccupiedBlocks) {
    const SkipScene scene = randomScene(40);
    const SkipOptions options = randomOptions();
    const auto octree = buildBooleanOctree(scene.visibility(), options);
    PROPERTY_ASSERT(octree.has_value());
    const OctreeLevel& leaves = octree->levels.front();
    FreeLengths lengths{.blocks = leaves.nodes, .blockEdgeVoxels = options.blockEdgeVoxels};
    for (const std::uint32_t occupied : leaves.words) {
        lengths.counts.push_back(occupied != 0 ? 0 : 1);
    }
    const auto expected = visibleBoxes(lengths, scene.geometry, 1.5);
    const auto boxes = visibleBoxes(*octree, booleanNodeTest(), scene.geometry, 1.5);
    PROPERTY_ASSERT(boxes.size() == expected.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        PROPERTY_ASSERT(boxes[i].low == expected[i].low);
        PROPERTY_ASSERT(boxes[i].high == expected[i].high);
    }
}

/// Small grains of two materials in a bulk whose value lies between theirs, and is not visible.
TEST(Octree, BitfieldsSeeTheGapThatOneRangeSpans) {
    SkipScene scene = test::constantScene(glm::ivec3(64), 120, test::bandTable(256, 30, 50));
    for (int k = 190; k <= 210; ++k) {
        scene.table.texels[k].a = 0.5F;
    }
    std::mt19937 random(5);
    for (int grain = 0; grain < 40; ++grain) {
        const std::uint16_t code = grain % 2 == 0 ? 40 : 200;
        const glm::ivec3 at(random() % 60, random() % 60, random() % 60);
        forBox(at, at + 4, [&](glm::ivec3 voxel) { scene.code(voxel) = code; });
    }
    const Octrees octrees = built(scene, SkipOptions{}, evenBins(scene, 32));
    const CellVisibility visibility = scene.visibility();
    const auto bits =
        visibleLeaves(octrees.bitfield.octree, bitfieldNodeTest(octrees.bitfield.bins, visibility));
    const auto range = visibleLeaves(octrees.minMax, minMaxNodeTest(visibility));
    const auto occupied = visibleLeaves(octrees.boolean, booleanNodeTest());
    RecordProperty("bitfield", std::to_string(bits));
    RecordProperty("minMax", std::to_string(range));
    EXPECT_EQ(range, 16 * 16 * 16); // the bulk lies between the materials
    EXPECT_EQ(bits, occupied);      // no bin is in a band and out of it where codes are
    EXPECT_LE(double(bits), 0.6 * double(range));
}

TEST(Octree, ValuesBetweenTwoBinsAreSeen) {
    // Four table texels to a value, of which one is visible: 127.5, between the bins 3 and 4 of 8.
    SkipScene scene = test::constantScene({12, 1, 1}, 127, test::bandTable(1021, 510, 510));
    scene.table.lastValue = 255.0;
    scene.code({6, 0, 0}) = 128;
    const SkipOptions options{.bits = 8};
    const Octrees octrees = built(scene, options, valueBins(scene.codes, {0, 255}, 8, false));
    EXPECT_EQ(octrees.bitfield.bins.binOfCode[127], 3);
    EXPECT_EQ(octrees.bitfield.bins.binOfCode[128], 4);
    // Cells from 5.5 to 7.5: of the leaves at 0, 4 and 8, grown by one voxel, those two that
    // follow.
    forEachOctree(octrees, scene.visibility(), [](const Octree& octree, const NodeTest& test) {
        EXPECT_FALSE(isFree(octree, octree.node(0, {1, 0, 0}), test));
        EXPECT_FALSE(isFree(octree, octree.node(0, {2, 0, 0}), test));
    });
    EXPECT_EQ(visibleLeaves(octrees.boolean, booleanNodeTest()), 2);
}

TEST(Octree, NothingVisibleIsFreeEverywhere) {
    const SkipScene scene = test::constantScene({9, 7, 5}, 255, test::bandTable(256, 0, -1));
    const Octrees octrees = built(scene, SkipOptions{}, evenBins(scene, 32));
    forEachOctree(octrees, scene.visibility(), [&](const Octree& octree, const NodeTest& test) {
        EXPECT_EQ(visibleLeaves(octree, test), 0);
        EXPECT_TRUE(visibleBoxes(octree, test, scene.geometry, 1.0).empty());
    });
}

TEST(Octree, AlphaIsItsOwnTable) {
    SkipScene scene = test::constantScene({40, 1, 1}, 0, {});
    scene.code({20, 0, 0}) = 1;
    const CellVisibility visibility = cellVisibilityOfAlpha(scene.codes);
    const auto octree = buildMinMaxOctree(scene.codes, SkipOptions{});
    ASSERT_TRUE(octree.has_value());
    EXPECT_EQ(minMaxNodeTest(visibility).words, glm::uvec4(1, 255, 0, 0));
    // Visible from 19.5 to 21.5, met by leaves of 4 grown by one voxel from 16 and from 20.
    EXPECT_EQ(visibleLeaves(*octree, minMaxNodeTest(visibility)), 2);
}

TEST(Octree, InitialLevelLeavesOutLevelsFromTheRoot) {
    EXPECT_EQ(levelsToRoot({1, 1, 1}), 1);
    EXPECT_EQ(levelsToRoot({2, 1, 1}), 2);
    EXPECT_EQ(levelsToRoot({1, 3, 1}), 3);
    EXPECT_EQ(levelsToRoot({4, 5, 2}), 4);
    const SkipScene scene = test::constantScene({33, 8, 8}, 0, test::bandTable(256, 1, 2));
    const int leavesAlong[] = {9, 5, 3, 2, 1}; // 33 voxels at 4 to a leaf, and up to the root
    for (const auto& [initial, kept] : {std::pair(0, 5), {1, 4}, {4, 1}, {9, 1}}) {
        const auto octree = buildMinMaxOctree(scene.codes, {.initialLevel = initial});
        ASSERT_TRUE(octree.has_value());
        ASSERT_EQ(int(octree->levels.size()), kept);
        for (int k = 0; k < kept; ++k) {
            EXPECT_EQ(octree->levels[k].nodes.x, leavesAlong[k]);
        }
    }
}

TEST(Octree, StopsWhenCancelled) {
    const SkipScene scene = test::constantScene(glm::ivec3(32), 9, test::bandTable(256, 0, 9));
    const CancelToken cancel(true);
    const SkipOptions options;
    const auto octree = buildMinMaxOctree(scene.codes, options, &cancel);
    ASSERT_FALSE(octree.has_value());
    EXPECT_EQ(octree.error().code, ErrorCode::Internal);
    EXPECT_FALSE(buildBooleanOctree(scene.visibility(), options, &cancel).has_value());
    EXPECT_FALSE(buildBitfieldOctree(scene.codes, evenBins(scene, 32), options, &cancel));
}

} // namespace
} // namespace slabcast

#include "core/skip/live_skip.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/skip/blocks.h"
#include "core/skip/chebyshev.h"
#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"
#include "tests/support/property.h"
#include "tests/support/skip_scene.h"

namespace slabcast {
namespace {

using test::anyBits;
using test::anyBool;
using test::anyElement;
using test::anyInt;
using test::bandTable;
using test::constantScene;
using test::fieldAt;
using test::SkipScene;
using test::tagCase;

constexpr double kOneItem = 1e-6; // ms: less than any item takes
constexpr double kAll = std::numeric_limits<double>::infinity();
constexpr int kTableSize = 256;

/// Balls of different values in air, some noise: neighbouring blocks share most of their values.
SkipScene ballScene(std::uint32_t seed, glm::ivec3 dims) {
    std::mt19937 random(seed);
    SkipScene scene = constantScene(dims, 0, bandTable(kTableSize, 100, 255));
    const int balls = 1 + int(random() % 4);
    for (int ball = 0; ball < balls; ++ball) {
        const glm::ivec3 middle(random() % dims.x, random() % dims.y, random() % dims.z);
        const int radius = 1 + int(random() % 6);
        const auto value = std::uint16_t(20 + random() % 230);
        for (int z = 0; z < dims.z; ++z) {
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x) {
                    const glm::ivec3 away = glm::ivec3(x, y, z) - middle;
                    if (away.x * away.x + away.y * away.y + away.z * away.z <= radius * radius) {
                        scene.code({x, y, z}) = std::uint16_t(value - random() % 3);
                    }
                }
            }
        }
    }
    scene.geometry.spacingMm = {1.0, 0.5 + random() % 3, 1.0};
    return scene;
}

LiveSource sourceOf(const SkipScene& scene) {
    return {std::make_shared<const TexelCodes>(scene.codes),
            std::make_shared<const Texels>(scene.texels), scene.geometry};
}

/// What each structure would be, built for the TF of now.
FreeLengths freshGrid(const SkipScene& scene, const SkipOptions& options) {
    const CellVisibility visibility = scene.visibility();
    switch (options.structure) {
    case SkipStructure::Proximity:
        return *buildProximityCloud(visibility, scene.geometry, options.blockEdgeVoxels);
    case SkipStructure::Blocks:
        return *buildBlocks(visibility, options.blockEdgeVoxels);
    default:
        return *buildChebyshev(visibility, options.blockEdgeVoxels);
    }
}

/// Nothing is called free further than it is.
bool isSafe(const SkipScene& scene, const BuiltSkip& skip) {
    const int edge = skip.options.blockEdgeVoxels;
    if (skip.octree) {
        const FreeLengths blocks = *buildBlocks(scene.visibility(), edge);
        for (int level = 0; level <= skip.octree->coarsest(); ++level) {
            std::size_t place = 0;
            for (int z = 0; z < blocks.blocks.z; ++z) {
                for (int y = 0; y < blocks.blocks.y; ++y) {
                    for (int x = 0; x < blocks.blocks.x; ++x, ++place) {
                        const auto* node = skip.octree->node(level, glm::ivec3(x, y, z) >> level);
                        if (blocks.counts[place] == 0 && isFree(*skip.octree, node, skip.test)) {
                            return false;
                        }
                    }
                }
            }
        }
        return true;
    }
    const FreeLengths fresh = freshGrid(scene, skip.options);
    return std::equal(skip.lengths->counts.begin(), skip.lengths->counts.end(),
                      fresh.counts.begin(), std::less_equal<>());
}

/// By the definition: where a sample is visible, its block is not free.
bool visibleSamplesAreKept(const SkipScene& scene, const BuiltSkip& skip, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 point =
            glm::dvec3(unit(random), unit(random), unit(random)) * glm::dvec3(scene.geometry.dims);
        if (lookUp(scene.table, fieldAt(scene, point)).w <= 0.0) {
            continue;
        }
        const glm::ivec3 block = glm::ivec3(point) / skip.options.blockEdgeVoxels;
        const auto free = [&] {
            if (skip.octree) {
                return isFree(*skip.octree, skip.octree->node(0, block), skip.test);
            }
            const glm::ivec3 n = skip.lengths->blocks;
            return skip.lengths->counts[(block.z * n.y + block.y) * n.x + block.x] != 0;
        };
        if (free()) {
            return false;
        }
    }
    return true;
}

/// Bands anywhere, or nothing at all.
TransferTable anyTable() {
    TransferTable table = bandTable(kTableSize, 0, -1);
    const int bands = anyInt(0, 4);
    for (int band = 0; band < bands; ++band) {
        const int first = anyInt(0, kTableSize);
        const int length = anyElement(1, 3, 40);
        for (int k = first; k < std::min(first + length, kTableSize); ++k) {
            table.texels[k].a = 0.5F;
        }
    }
    return table;
}

/// Of the same visible values, or fewer.
TransferTable derivedTable(TransferTable table, bool fewer) {
    const int first = anyInt(0, kTableSize);
    for (int k = 0; k < kTableSize; ++k) {
        table.texels[k].a *= fewer && k >= first && k < first + 30 ? 0.0F : 0.75F;
    }
    return table;
}

LiveOptions anyOptions() {
    LiveOptions options;
    options.always.structure =
        anyElement(SkipStructure::BitfieldOctree, SkipStructure::BitfieldOctree,
                   SkipStructure::MinMaxOctree, SkipStructure::Partitioned);
    options.always.blockEdgeVoxels = anyElement(2, 2, 4);
    options.always.bits = anyElement(16, 32, 128);
    options.always.initialLevel = anyInt(0, 3);
    options.settled.structure =
        anyElement(SkipStructure::Proximity, SkipStructure::Chebyshev, SkipStructure::Blocks);
    options.settled.blockEdgeVoxels = anyElement(2, 2, 4);
    options.quietFrames = anyInt(0, 3);
    return options;
}

BuiltSkip builtNow(const SkipScene& scene, const SkipOptions& options) {
    return *buildSkip({scene.codes, scene.texels, scene.visibility(), scene.geometry}, options);
}

/// Works until nothing is left to do.
void settle(LiveSkip& live) {
    for (int frame = 0; frame < 1000 && !live.isSettled(); ++frame) {
        live.work(kAll);
    }
    ASSERT_TRUE(live.isSettled());
}

PROPERTY(LiveSkip, IsExactAtEveryMomentAndTightInTheEnd) {
    SkipScene scene = ballScene(anyBits(), {anyInt(1, 30), anyInt(1, 24), 17});
    const LiveOptions options = anyOptions();
    const bool hasPresent = anyBool();
    auto live = LiveSkip::start(sourceOf(scene), options, scene.visibility(),
                                builtNow(scene, hasPresent ? options.settled : options.always));
    PROPERTY_ASSERT(live.has_value());
    const int steps = anyInt(1, 12);
    for (int step = 0; step < steps; ++step) {
        switch (anyInt(0, 6)) {
        case 0:
            scene.table = anyTable();
            live->edit(scene.visibility());
            break;
        case 1:
            scene.table = derivedTable(scene.table, anyBool());
            live->edit(scene.visibility());
            break;
        default:
            live->work(anyElement(0.0, kOneItem, kOneItem, kOneItem, kAll));
        }
        PROPERTY_ASSERT(isSafe(scene, live->current()));
        PROPERTY_ASSERT(visibleSamplesAreKept(scene, live->current(), std::uint32_t(step)));
    }
    settle(*live);
    PROPERTY_ASSERT(live->current().options.structure == options.settled.structure);
    PROPERTY_ASSERT(live->current().lengths->counts == freshGrid(scene, options.settled).counts);
}

PROPERTY(LiveSkip, MarkingWhatMayHaveChangedIsMarkingAll) {
    SkipScene scene = ballScene(anyBits(), {64, 40, 33});
    scene.table = anyTable();
    const SkipOptions octreeOptions{
        .structure = SkipStructure::BitfieldOctree, .blockEdgeVoxels = 2, .initialLevel = 0};
    const BuiltSkip octree = builtNow(scene, octreeOptions);
    const BuiltSkip before =
        builtNow(scene, {.structure = SkipStructure::Chebyshev, .blockEdgeVoxels = 2});
    const VisibleValues shownBefore = visibleValues(scene.visibility());
    scene.table = anyTable();
    const auto now = std::make_shared<const CellVisibility>(scene.visibility());
    const BinSet bins = changedBins(*octree.bins, shownBefore, visibleValues(*now));
    const int level = anyInt(0, 4);
    ChangedRegions regions{level, visibleNodes(*octree.octree, {{bins[0], 0, 0, 0}}, level)};
    const std::size_t cubes = regions.cubes.size();
    tagCase(cubes == 0                                          ? "no region"
            : cubes < octree.octree->levels[level].words.size() ? "some regions"
                                                                : "all regions");
    const auto ranges = std::make_shared<const OctreeLevel>(*blockRanges(scene.codes, 2));
    GridRebuild rebuild({SkipStructure::Chebyshev, 2, scene.geometry, ranges}, now,
                        {before.lengths, std::move(regions)});
    while (!rebuild.work(GridRebuild::Clock::time_point::min())) {
    }
    const FreeLengths fresh =
        freshGrid(scene, {.structure = SkipStructure::Chebyshev, .blockEdgeVoxels = 2});
    PROPERTY_ASSERT(*rebuild.finish() == fresh);
}

PROPERTY(LiveSkip, VisibleValuesTellWhichCellsAreVisible) {
    SkipScene scene = constantScene(glm::ivec3(1), 0, anyTable());
    const CellVisibility visibility = scene.visibility(anyElement(0.0, 0.4, 5.0));
    const VisibleValues values = visibleValues(visibility);
    for (int a = 0; a < 256; a += 3) {
        bool any = false;
        for (int b = a; b < 256; ++b) {
            any = any || (b > a && (values.shown[b - 1] & VisibleValues::kWithNext) != 0) ||
                  (values.shown[b] & VisibleValues::kAlone) != 0;
            PROPERTY_ASSERT(visibility.visible(std::uint16_t(a), std::uint16_t(b)) == any);
        }
    }
}

PROPERTY(LiveSkip, CoversIsForEveryCell) {
    SkipScene scene = constantScene(glm::ivec3(1), 0, anyTable());
    const CellVisibility one = scene.visibility();
    scene.table = anyBool() ? derivedTable(scene.table, true) : anyTable();
    const CellVisibility other = scene.visibility();
    bool covered = true;
    bool same = true;
    for (int a = 0; a < 256; ++a) {
        for (int b = a; b < 256; ++b) {
            const bool shownByOne = one.visible(std::uint16_t(a), std::uint16_t(b));
            const bool shownByOther = other.visible(std::uint16_t(a), std::uint16_t(b));
            covered = covered && (shownByOne || !shownByOther);
            same = same && shownByOne == shownByOther;
        }
    }
    tagCase(same ? "same" : covered ? "covered" : "more");
    PROPERTY_ASSERT(covers(visibleValues(one), visibleValues(other)) == covered);
    PROPERTY_ASSERT((visibleValues(one) == visibleValues(other)) == same);
    PROPERTY_ASSERT(changedCodes(visibleValues(one), visibleValues(other)).has_value() == !same);
}

/// A bright ball in a dim one, both shown.
class LiveSkipTest : public ::testing::Test {
protected:
    LiveSkipTest() : scene(constantScene({24, 24, 24}, 0, bandTable(kTableSize, 50, 255))) {
        for (int z = 6; z < 18; ++z) {
            for (int y = 6; y < 18; ++y) {
                for (int x = 6; x < 18; ++x) {
                    const bool inner = std::max({x, y, z}) < 11;
                    scene.code({x, y, z}) = inner ? 200 : 100;
                }
            }
        }
    }
    LiveSkip started() {
        const BuiltSkip present = builtNow(scene, options.settled);
        return std::move(*LiveSkip::start(sourceOf(scene), options, scene.visibility(), present));
    }
    void edit(LiveSkip& live, int first, int last) {
        scene.table = bandTable(kTableSize, first, last);
        live.edit(scene.visibility());
    }

    SkipScene scene;
    LiveOptions options;
};

TEST_F(LiveSkipTest, BeginsWithWhatIsThere) {
    const LiveSkip live = started();
    EXPECT_EQ(live.current().options.structure, SkipStructure::Proximity);
    EXPECT_TRUE(live.isSettled());
}

TEST_F(LiveSkipTest, EditThatShowsMoreIsServedByTheOctreeAtOnce) {
    LiveSkip live = started();
    edit(live, 0, 255);
    EXPECT_EQ(live.current().options.structure, SkipStructure::BitfieldOctree);
    EXPECT_FALSE(live.isSettled());
}

TEST_F(LiveSkipTest, SameVisibleValuesRebuildNothing) {
    LiveSkip live = started();
    const int generation = live.current().generation;
    for (glm::vec4& texel : scene.table.texels) {
        texel.a *= 0.1F;
    }
    live.edit(scene.visibility());
    EXPECT_EQ(live.current().generation, generation);
    for (int frame = 0; frame < 10; ++frame) {
        EXPECT_EQ(live.work(kAll), LiveProgress::Settled);
    }
}

TEST_F(LiveSkipTest, SomewhatFewerVisibleValuesKeepTheMapUntilItIsTightened) {
    for (int place = 0; place < 24 * 24 * 24; ++place) {
        const int x = place % 24;
        scene.code({x, place / 24 % 24, place / 576}) = x < 20 ? 100 : 200;
    }
    options.always.blockEdgeVoxels = options.settled.blockEdgeVoxels = 2;
    LiveSkip live = started();
    const int generation = live.current().generation;
    edit(live, 50, 150); // all blocks but those of the last two voxels along x
    EXPECT_EQ(live.current().generation, generation);
    settle(live);
    EXPECT_NE(live.current().generation, generation);
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
    EXPECT_EQ(live.current().lengths->occupiedBlocks, 11 * 12 * 12);
}

TEST_F(LiveSkipTest, MuchFewerVisibleValuesAreServedByTheOctreeWhichSkipsMore) {
    LiveSkip live = started();
    edit(live, 150, 255); // the inner ball alone
    EXPECT_EQ(live.current().options.structure, SkipStructure::BitfieldOctree);
    settle(live);
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, EditsThatChangeNoBlockKeepTheTexture) {
    LiveSkip live = started();
    const int generation = live.current().generation;
    edit(live, 90, 230); // other visible values, the same blocks
    settle(live);
    EXPECT_EQ(live.current().generation, generation);
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, WhoComesBackFindsTheMapAgain) {
    LiveSkip live = started();
    const int generation = live.current().generation;
    edit(live, 0, 255);
    edit(live, 50, 255);
    EXPECT_EQ(live.current().generation, generation);
    EXPECT_TRUE(live.isSettled());
}

TEST_F(LiveSkipTest, EditsInEveryFrameBuildNoCloud) {
    LiveSkip live = started();
    for (int frame = 0; frame < 40; ++frame) {
        edit(live, frame, 60 + frame);
        EXPECT_EQ(live.work(kAll), LiveProgress::Waiting) << frame;
    }
}

TEST_F(LiveSkipTest, RebuildingBeginsWhenTheHandHasComeToRest) {
    LiveSkip live = started();
    edit(live, 0, 255);
    for (int frame = 0; frame < options.quietFrames; ++frame) {
        EXPECT_EQ(live.work(kAll), LiveProgress::Waiting);
    }
    EXPECT_EQ(live.work(0.0), LiveProgress::Waiting) << "no budget, no work";
    EXPECT_EQ(live.work(kOneItem), LiveProgress::Building);
    edit(live, 20, 255);
    for (int frame = 0; frame < options.quietFrames; ++frame) {
        EXPECT_EQ(live.work(kAll), LiveProgress::Waiting) << "begun anew";
    }
    EXPECT_EQ(live.work(kAll), LiveProgress::Swapped);
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, NoBudgetIsTooSmallToFinish) {
    LiveSkip live = started();
    edit(live, 0, 255);
    int calls = 0;
    while (live.work(kOneItem) != LiveProgress::Swapped) {
        ASSERT_LT(++calls, 200); // 6 slices and rows, of 4 stages, one for the count of blocks
    }
    EXPECT_GT(calls, 8) << "in pieces";
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, AMapOfMoreThanAFramesShareIsUploadedBeforeItServes) {
    options.settled.blockEdgeVoxels = 1;
    scene = constantScene({104, 104, 104}, 200, bandTable(kTableSize, 0, 100));
    scene.code({50, 50, 50}) = 50;
    LiveSkip live = started();
    ASSERT_GT(gpuBytes(live.settled()), kUploadBytesPerFrame);
    ASSERT_LE(gpuBytes(live.settled()), 2 * kUploadBytesPerFrame);
    const auto workToRest = [&] {
        for (int frame = 0; frame < options.quietFrames; ++frame) {
            live.work(kAll);
        }
        return live.work(kAll);
    };
    edit(live, 0, 199);
    EXPECT_EQ(workToRest(), LiveProgress::Incoming);
    EXPECT_TRUE(live.incoming().exists());
    EXPECT_FALSE(live.isSettled());
    edit(live, 150, 199);
    EXPECT_FALSE(live.incoming().exists()) << "of another transfer function";
    EXPECT_EQ(workToRest(), LiveProgress::Incoming);
    EXPECT_EQ(live.work(0.0), LiveProgress::Waiting) << "no budget, no work";
    const int generation = live.incoming().generation;
    EXPECT_EQ(live.work(kAll), LiveProgress::Swapped);
    EXPECT_EQ(live.current().generation, generation);
    EXPECT_FALSE(live.incoming().exists());
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, OtherColoursLeaveWhatIsInTheMaking) {
    LiveSkip live = started();
    edit(live, 0, 255);
    for (int frame = 0; frame < options.quietFrames; ++frame) {
        live.work(kAll);
    }
    EXPECT_EQ(live.work(kOneItem), LiveProgress::Building);
    for (glm::vec4& texel : scene.table.texels) {
        texel.a *= 0.1F;
    }
    live.edit(scene.visibility());
    EXPECT_EQ(live.work(kOneItem), LiveProgress::Building) << "without waiting anew";
    EXPECT_EQ(live.work(kAll), LiveProgress::Swapped);
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, AMapOfAWiderTransferFunctionServesUntilItIsTightened) {
    const BuiltSkip wide = builtNow(scene, options.settled);
    scene.table = bandTable(kTableSize, 150, 255);
    LiveSkip live = *LiveSkip::start(sourceOf(scene), options, scene.visibility(), wide);
    EXPECT_EQ(live.current().generation, wide.generation);
    EXPECT_FALSE(live.isSettled());
    settle(live);
    EXPECT_EQ(*live.current().lengths, freshGrid(scene, options.settled));
}

TEST_F(LiveSkipTest, CopiesGoTheirOwnWays) {
    LiveSkip live = started();
    edit(live, 0, 255);
    for (int frame = 0; frame <= options.quietFrames; ++frame) {
        live.work(kOneItem);
    }
    LiveSkip copy = live;
    settle(copy);
    EXPECT_TRUE(copy.isSettled());
    EXPECT_FALSE(live.isSettled());
    EXPECT_EQ(live.current().options.structure, SkipStructure::BitfieldOctree);
    settle(live);
    EXPECT_EQ(*live.current().lengths, *copy.current().lengths);
}

TEST_F(LiveSkipTest, WithoutASettledStructureTheOctreeServesAlways) {
    options.settled.structure = SkipStructure::None;
    LiveSkip live = started();
    EXPECT_TRUE(live.isSettled());
    edit(live, 0, 255);
    EXPECT_EQ(live.work(kAll), LiveProgress::Settled);
    EXPECT_EQ(live.current().options.structure, SkipStructure::BitfieldOctree);
}

TEST_F(LiveSkipTest, StructuresThatCannotServeAreRefused) {
    const auto refused = [&](SkipStructure always, SkipStructure settled) {
        options.always.structure = always;
        options.settled.structure = settled;
        const auto live = LiveSkip::start(sourceOf(scene), options, scene.visibility(), {});
        return !live && live.error().code == ErrorCode::InvalidArgument;
    };
    EXPECT_TRUE(refused(SkipStructure::Proximity, SkipStructure::None));
    EXPECT_TRUE(refused(SkipStructure::BooleanOctree, SkipStructure::None));
    EXPECT_TRUE(refused(SkipStructure::None, SkipStructure::None));
    EXPECT_TRUE(refused(SkipStructure::BitfieldOctree, SkipStructure::BooleanOctree));
    EXPECT_TRUE(refused(SkipStructure::BitfieldOctree, SkipStructure::Partitioned));
    EXPECT_FALSE(refused(SkipStructure::MinMaxOctree, SkipStructure::Blocks));
}

} // namespace
} // namespace slabcast

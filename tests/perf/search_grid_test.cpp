#include "perf/skip/search_grid.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/skip/octree.h"

using namespace slabcast;
using skipbench::searchGrid;

namespace {

bool allDiffer(const std::vector<SkipOptions>& grid) {
    for (std::size_t k = 0; k < grid.size(); ++k) {
        if (std::find(grid.begin() + static_cast<std::ptrdiff_t>(k) + 1, grid.end(), grid[k]) !=
            grid.end()) {
            return false;
        }
    }
    return true;
}

TEST(SkipSearchGrid, EveryChoiceIsTriedOnceAndCanBeBuilt) {
    for (const SkipStructureInfo& info : skipStructures()) {
        if (info.structure == SkipStructure::None) {
            continue;
        }
        for (const bool quick : {false, true}) {
            const std::vector<SkipOptions> grid =
                searchGrid(info.structure, {256, 256, 108}, quick);
            EXPECT_GE(grid.size(), 2U) << info.name;
            EXPECT_TRUE(allDiffer(grid)) << info.name;
            for (const SkipOptions& options : grid) {
                EXPECT_EQ(options.structure, info.structure);
                EXPECT_TRUE(check(options).has_value()) << info.name;
            }
        }
    }
}

TEST(SkipSearchGrid, AnOctreesAxesAreMultiplied) {
    // Leaves of 2, 4, 8 or 16 voxels; 0 to 5 levels left out, but for the largest leaves, of which
    // 16 lie along an axis, no more than 4; both traversals; five sizes of bitfields.
    const std::size_t levels = 6 + 6 + 6 + 5;
    const auto minMax = searchGrid(SkipStructure::MinMaxOctree, glm::ivec3(256), false);
    EXPECT_EQ(minMax.size(), 2 * levels);
    const auto bitfield = searchGrid(SkipStructure::BitfieldOctree, glm::ivec3(256), false);
    EXPECT_EQ(bitfield.size(), 5 * minMax.size());
}

TEST(SkipSearchGrid, NoOctreeBeginsBelowItsLeaves) {
    const auto grid = searchGrid(SkipStructure::BooleanOctree, glm::ivec3(24), false);
    for (const SkipOptions& options : grid) {
        EXPECT_LT(options.initialLevel,
                  levelsToRoot(blocksOf(glm::ivec3(24), options.blockEdgeVoxels)));
    }
}

TEST(SkipSearchGrid, OfOneLeafNoLevelCanBeLeftOut) {
    const auto grid = searchGrid(SkipStructure::MinMaxOctree, glm::ivec3(1), false);
    EXPECT_EQ(grid.size(), 4U * 2); // edges and traversals
    for (const SkipOptions& options : grid) {
        EXPECT_EQ(options.initialLevel, 0);
    }
}

} // namespace

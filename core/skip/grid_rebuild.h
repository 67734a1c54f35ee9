#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "core/skip/build_stages.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/skip/skip_structure.h"
#include "core/volume/volume.h"

namespace slabcast {

/// What a grid of free lengths is rebuilt from, whatever the TF.
struct GridSource {
    SkipStructure structure = SkipStructure::Proximity; // or Chebyshev, or Blocks
    int blockEdgeVoxels = 4;
    VolumeGeometry geometry;
    std::shared_ptr<const OctreeLevel> ranges; // blockRanges()
};

/// Cubes of 2^level blocks along each axis, among which are all blocks that two TFs show
/// differently.
struct ChangedRegions {
    int level = 0;
    std::vector<glm::ivec3> cubes;
};

/// A finished grid, of another TF.
struct EarlierGrid {
    std::shared_ptr<const FreeLengths> grid;
    /// Blocks outside these are as they were. Nothing: all may differ.
    std::optional<ChangedRegions> changed;
};

/// A grid in the making: blocks are marked, all or those that may have changed; then, where any
/// differs from the earlier grid's, free lengths are found anew. Begun and gone on with a few items
/// at a time. Tested by: live_skip_test.cpp
class GridRebuild {
public:
    using Clock = std::chrono::steady_clock;

    /// `visibility` is kept, and its codes are not read.
    GridRebuild(GridSource source, std::shared_ptr<const CellVisibility> visibility,
                EarlierGrid earlier);
    GridRebuild(const GridRebuild&) = delete;
    GridRebuild& operator=(const GridRebuild&) = delete;

    /// Runs items on all cores, one at least; begins no other that would be late if it took as
    /// long as the one before. Whether all is done.
    bool work(Clock::time_point deadline);

    /// The earlier grid itself where no block differs. Contract: all is done; asked once.
    std::shared_ptr<const FreeLengths> finish();

private:
    void markAll(std::uint8_t freeByte);
    void markChanged(std::uint8_t freeByte);
    void compareWithEarlier();
    void addDistances();

    GridSource source_;
    std::shared_ptr<const CellVisibility> visibility_;
    EarlierGrid earlier_;
    FreeLengths grid_;
    BuildStages stages_;
    std::size_t distances_ = 0; // the first stage that is not needed where no block differs
    std::atomic<bool> differs_;
    std::size_t stage_ = 0;
    std::int64_t item_ = 0;
};

} // namespace slabcast

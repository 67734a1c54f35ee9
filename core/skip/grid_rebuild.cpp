#include "core/skip/grid_rebuild.h"

#include <algorithm>

#include "core/base/executor.h"
#include "core/base/parallel.h"
#include "core/skip/chebyshev.h"
#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"

namespace slabcast {

namespace {

using Clock = GridRebuild::Clock;

/// Runs items of a stage from `from` on, one at least; returns the first that was not run. A
/// further one is begun where it is over by the deadline if it takes as long as the one before.
/// Threads are called only where there is time for more than one item.
std::int64_t runItems(const BuildStage& stage, std::int64_t from, Clock::time_point deadline) {
    std::atomic<std::int64_t> next{from};
    const auto runOne = [&](Clock::duration& took) {
        const std::int64_t item = next.fetch_add(1);
        if (item >= stage.items) {
            return false;
        }
        const auto start = Clock::now();
        stage.run(item, item + 1);
        took = Clock::now() - start;
        return item + 1 < stage.items;
    };
    Clock::duration first{};
    if (runOne(first) && Clock::now() + first < deadline) {
        const auto runWhileThereIsTime = [&](std::int64_t, std::int64_t) {
            Clock::duration took = first;
            while (Clock::now() + took < deadline && runOne(took)) {
            }
        };
        const std::int64_t cores = executor().concurrency();
        parallelFor(stage.inOrder ? 1 : std::min(cores, stage.items - from - 1), 1,
                    runWhileThereIsTime);
    }
    return std::min<std::int64_t>(next, stage.items);
}

bool visible(const CellVisibility& visibility, std::uint32_t rangeWord) {
    const NodeRange range = NodeRange::of(rangeWord);
    return visibility.visible(std::uint16_t(range.least), std::uint16_t(range.greatest));
}

std::int64_t blocksPerSlice(const FreeLengths& grid) {
    return std::int64_t(grid.blocks.x) * grid.blocks.y;
}

} // namespace

GridRebuild::GridRebuild(GridSource source, std::shared_ptr<const CellVisibility> visibility,
                         EarlierGrid earlier)
    : source_(std::move(source)), visibility_(std::move(visibility)), earlier_(std::move(earlier)),
      differs_(earlier_.grid == nullptr) {
    const std::uint8_t freeByte = source_.structure == SkipStructure::Blocks ? 1 : 255;
    if (earlier_.grid && earlier_.changed) {
        markChanged(freeByte);
    } else {
        markAll(freeByte);
    }
    if (earlier_.grid) {
        SLABCAST_EXPECTS(earlier_.grid->blocks == grid_.blocks, grid_.blocks.x);
        compareWithEarlier();
    }
    distances_ = stages_.size();
    addDistances();
}

void GridRebuild::markAll(std::uint8_t freeByte) {
    stages_ = occupancyStages(*source_.ranges, source_.blockEdgeVoxels, *visibility_,
                              {.free = freeByte, .occupied = 0}, grid_);
}

// A block outside of the regions is marked as it was: no cell that meets it grown by one voxel is
// shown differently (see visible_values.cpp), and its byte is zero where it was occupied, whatever
// became of the others.
void GridRebuild::markChanged(std::uint8_t freeByte) {
    const FreeLengths& before = *earlier_.grid;
    grid_ = {.blocks = before.blocks, .blockEdgeVoxels = before.blockEdgeVoxels};
    stages_.push_back(roomFor(grid_));
    const std::int64_t perSlice = blocksPerSlice(grid_);
    stages_.push_back({grid_.blocks.z, [=, this, &before](std::int64_t begin, std::int64_t end) {
                           const std::uint8_t* counts = before.counts.data();
                           std::transform(counts + begin * perSlice, counts + end * perSlice,
                                          grid_.counts.data() + begin * perSlice,
                                          [=](std::uint8_t count) {
                                              return count == 0 ? std::uint8_t(0) : freeByte;
                                          });
                       }});
    const auto added = std::make_shared<std::atomic<std::int64_t>>(before.occupiedBlocks);
    const auto markCube = [=, this](glm::ivec3 cube, int level) {
        const glm::ivec3 first = cube << level;
        const glm::ivec3 end = glm::min((cube + 1) << level, grid_.blocks);
        const std::uint32_t* words = source_.ranges->words.data();
        std::uint8_t* counts = grid_.counts.data();
        std::int64_t more = 0;
        for (int z = first.z; z < end.z; ++z) {
            for (int y = first.y; y < end.y; ++y) {
                const std::int64_t row = z * perSlice + std::int64_t(y) * grid_.blocks.x;
                for (std::int64_t i = row + first.x; i < row + end.x; ++i) {
                    const bool occupied = visible(*visibility_, words[i]);
                    more += int(occupied) - int(counts[i] == 0);
                    counts[i] = occupied ? 0 : freeByte;
                }
            }
        }
        *added += more;
    };
    const ChangedRegions& regions = *earlier_.changed;
    stages_.push_back(
        {std::int64_t(regions.cubes.size()), [=, &regions](std::int64_t begin, std::int64_t end) {
             for (std::int64_t i = begin; i < end; ++i) {
                 markCube(regions.cubes.data()[i], regions.level);
             }
         }});
    stages_.push_back(
        {1, [=, this](std::int64_t, std::int64_t) { grid_.occupiedBlocks = *added; }});
}

void GridRebuild::compareWithEarlier() {
    const std::int64_t perSlice = blocksPerSlice(grid_);
    const auto compareSlices = [=, this](std::int64_t begin, std::int64_t end) {
        const std::uint8_t* first = grid_.counts.data() + begin * perSlice;
        const bool same =
            std::equal(first, first + (end - begin) * perSlice,
                       earlier_.grid->counts.data() + begin * perSlice,
                       [](std::uint8_t a, std::uint8_t b) { return (a == 0) == (b == 0); });
        if (!same) {
            differs_ = true;
        }
    };
    stages_.push_back({grid_.blocks.z, compareSlices});
}

void GridRebuild::addDistances() {
    BuildStages more;
    if (source_.structure == SkipStructure::Proximity) {
        more = proximityStages(source_.geometry, grid_);
    } else if (source_.structure == SkipStructure::Chebyshev) {
        more = chebyshevStages(grid_);
    }
    stages_.insert(stages_.end(), more.begin(), more.end());
}

bool GridRebuild::work(Clock::time_point deadline) {
    const auto stagesNeeded = [this] {
        return stage_ >= distances_ && !differs_ ? distances_ : stages_.size();
    };
    bool ranOne = false;
    while (stage_ < stagesNeeded() && (!ranOne || Clock::now() < deadline)) {
        item_ = runItems(stages_[stage_], item_, deadline);
        ranOne = true;
        if (item_ < stages_[stage_].items) {
            break; // no time for another
        }
        item_ = 0;
        ++stage_;
    }
    return stage_ >= stagesNeeded();
}

std::shared_ptr<const FreeLengths> GridRebuild::finish() {
    SLABCAST_EXPECTS(stage_ >= distances_, stage_);
    return differs_ ? std::make_shared<const FreeLengths>(std::move(grid_)) : earlier_.grid;
}

} // namespace slabcast

#include "core/skip/blocks.h"

#include "core/skip/occupancy.h"

namespace slabcast {

BuildStages blocksStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                         const CellVisibility& visibility, FreeLengths& result) {
    return occupancyStages(ranges, blockEdgeVoxels, visibility, {.free = 1, .occupied = 0}, result);
}

Result<FreeLengths> buildBlocks(const CellVisibility& visibility, int blockEdgeVoxels,
                                const CancelToken* cancel) {
    const auto stages = [&](const OctreeLevel& ranges, FreeLengths& result) {
        return blocksStages(ranges, blockEdgeVoxels, visibility, result);
    };
    return buildGrid(SkipStructure::Blocks, visibility, blockEdgeVoxels, stages, cancel);
}

} // namespace slabcast

#include "core/skip/occupancy.h"

#include <limits>
#include <memory>
#include <numeric>

#include "core/skip/minmax_octree.h"

namespace slabcast {

Result<OctreeLevel> blockRanges(const TexelCodes& codes, int blockEdgeVoxels,
                                const CancelToken* cancel) {
    const SkipOptions leavesAlone{.structure = SkipStructure::MinMaxOctree,
                                  .blockEdgeVoxels = blockEdgeVoxels,
                                  .initialLevel = std::numeric_limits<int>::max()};
    return buildMinMaxOctree(codes, leavesAlone, cancel).map([](Octree&& octree) {
        return std::move(octree.levels.front());
    });
}

BuildStage roomFor(FreeLengths& grid) {
    const std::int64_t perSlice = std::int64_t(grid.blocks.x) * grid.blocks.y;
    grid.counts.reserve(std::size_t(perSlice * grid.blocks.z));
    const auto addSlices = [=, &grid](std::int64_t, std::int64_t end) {
        grid.counts.resize(std::size_t(end * perSlice));
    };
    return {.items = grid.blocks.z, .run = addSlices, .inOrder = true};
}

// A block's range settles what its cells would one by one. If none of them is visible, each either
// ends below the first visible table texel t that the block's least code can reach, or begins above
// it: were it neither, it would reach t. The cell with the least code ends below; so do its
// neighbours, since what two cells share is not on both sides of t, and theirs in turn. The cell
// with the greatest code does not reach t either, then, and the block's range is not visible.
BuildStages occupancyStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                            const CellVisibility& visibility, BlockBytes bytes, FreeLengths& grid) {
    const glm::ivec3 blocks = ranges.nodes;
    const std::int64_t perSlice = std::int64_t(blocks.x) * blocks.y;
    SLABCAST_EXPECTS(std::int64_t(ranges.words.size()) == perSlice * blocks.z, blocks.z);
    grid = {.blocks = blocks, .blockEdgeVoxels = blockEdgeVoxels};
    const auto occupiedInSlice = std::make_shared<std::vector<std::int64_t>>(blocks.z);
    const auto markSlices = [=, &ranges, &visibility, &grid](std::int64_t begin, std::int64_t end) {
        const std::uint32_t* words = ranges.words.data();
        std::uint8_t* counts = grid.counts.data();
        for (std::int64_t z = begin; z < end; ++z) {
            std::int64_t occupied = 0;
            for (std::int64_t i = z * perSlice; i < (z + 1) * perSlice; ++i) {
                const NodeRange range = NodeRange::of(words[i]);
                const bool visible =
                    visibility.visible(std::uint16_t(range.least), std::uint16_t(range.greatest));
                counts[i] = visible ? bytes.occupied : bytes.free;
                occupied += visible;
            }
            occupiedInSlice->data()[z] = occupied;
        }
    };
    const auto count = [=, &grid](std::int64_t, std::int64_t) {
        grid.occupiedBlocks =
            std::accumulate(occupiedInSlice->begin(), occupiedInSlice->end(), std::int64_t(0));
    };
    return {roomFor(grid), {blocks.z, markSlices}, {1, count}};
}

Result<FreeLengths> buildGrid(SkipStructure structure, const CellVisibility& visibility,
                              int blockEdgeVoxels, const GridStages& stages,
                              const CancelToken* cancel) {
    FreeLengths grid;
    return check({.structure = structure, .blockEdgeVoxels = blockEdgeVoxels})
        .and_then([&] { return blockRanges(*visibility.texels, blockEdgeVoxels, cancel); })
        .and_then(
            [&](const OctreeLevel& ranges) { return runStages(stages(ranges, grid), cancel); })
        .map([&] { return std::move(grid); });
}

} // namespace slabcast

#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/build_stages.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/skip/skip_structure.h"

namespace slabcast {

/// Least and greatest code of the cells that meet each block grown by one voxel: the leaves of a
/// min-max octree, from which the occupancy under any TF follows block by block. Cost: O(voxels),
/// all cores. Fails: Internal where cancelled. Tested by: chebyshev_test.cpp
Result<OctreeLevel> blockRanges(const TexelCodes& codes, int blockEdgeVoxels,
                                const CancelToken* cancel = nullptr);

/// What a block's byte becomes.
struct BlockBytes {
    std::uint8_t free;
    std::uint8_t occupied;
};

/// Makes room for a grid's bytes slice by slice: memory is slow when it is first touched. Contract:
/// the shape of `grid` is set.
BuildStage roomFor(FreeLengths& grid);

/// Occupancy as the bytes that a grid of lengths begins with, and how many blocks are occupied,
/// which a block is where a visible cell meets it grown by one voxel on each side. The voxel of
/// margin absorbs what the texture unit's addressing and rounded positions may add; no length that
/// is stored counts on it. The shape of `grid` is set at once. Cost: O(blocks). Tested by:
/// chebyshev_test.cpp
BuildStages occupancyStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                            const CellVisibility& visibility, BlockBytes bytes, FreeLengths& grid);

/// Stages of a grid, from the ranges of its blocks.
using GridStages = std::function<BuildStages(const OctreeLevel& ranges, FreeLengths& grid)>;

/// A grid all at once, from the visibility's codes. Fails: InvalidArgument (block edge not offered
/// by the structure), Internal where cancelled.
Result<FreeLengths> buildGrid(SkipStructure structure, const CellVisibility& visibility,
                              int blockEdgeVoxels, const GridStages& stages,
                              const CancelToken* cancel);

} // namespace slabcast

#pragma once

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/build_stages.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"

namespace slabcast {

/// Free or not, block by block: 0 where a visible cell may be met, else 1, also where nothing is
/// visible, since nothing is known beyond the block. Cost: O(voxels), all cores. Fails:
/// InvalidArgument (block edge not offered), Internal where cancelled. Tested by:
/// chebyshev_test.cpp
Result<FreeLengths> buildBlocks(const CellVisibility& visibility, int blockEdgeVoxels,
                                const CancelToken* cancel = nullptr);

/// The same in stages, from the ranges of the blocks: O(blocks).
BuildStages blocksStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                         const CellVisibility& visibility, FreeLengths& result);

} // namespace slabcast

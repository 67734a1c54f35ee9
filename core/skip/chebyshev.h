#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/build_stages.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"

namespace slabcast {

/// Max-norm distances in a grid of bytes, in place: 0 at sites and 255 elsewhere become the
/// distance to the closest site, clamped to 255. Three steps, one after the other, each over all
/// slices, of which [begin, end) may be any part. Cost: O(slices), on the calling thread.
/// Source: Rosenfeld and Pfaltz 1968 (chessboard distance by sweeps), a dimension at a time.
struct ChebyshevTransform {
    glm::ivec3 size{0};
    std::uint8_t* bytes = nullptr; // x fastest

    /// Distances inside each slice by itself: any order, any threads.
    void withinSlices(std::int64_t begin, std::int64_t end) const;
    /// From slice to slice, in rising order.
    void upwards(std::int64_t begin, std::int64_t end) const;
    /// The same in falling order: slices count from the last one.
    void downwards(std::int64_t begin, std::int64_t end) const;
};

/// Distance in blocks to the closest one that a visible cell may meet: 1 beside it, so that a block
/// grown by one less is free. Cost: O(voxels) for occupancy, O(blocks) for the transform; all
/// cores but for two sweeps at the pace of memory. Fails: InvalidArgument (block edge not offered),
/// Internal where cancelled. Source: Deakin and Knackstedt 2019, section 3; the cell rule is ours.
/// Tested by: chebyshev_test.cpp
Result<FreeLengths> buildChebyshev(const CellVisibility& visibility, int blockEdgeVoxels,
                                   const CancelToken* cancel = nullptr);

/// The same in stages, from the ranges of the blocks: O(blocks).
BuildStages chebyshevStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                            const CellVisibility& visibility, FreeLengths& result);

/// The distances alone, of a grid whose bytes are 0 where occupied and else 255.
BuildStages chebyshevStages(FreeLengths& marked);

} // namespace slabcast

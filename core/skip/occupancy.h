#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/cell_visibility.h"

namespace slabcast {

/// Which blocks of e^3 voxels a ray may not skip. Block b spans [b*e, (b+1)*e] in voxel
/// coordinates, the last one of an axis possibly beyond the volume. Shape: blocks, x fastest; 1
/// where occupied, else 0.
struct Occupancy {
    glm::ivec3 blocks{0};
    std::vector<std::uint8_t> occupied;
};

/// A block is occupied where a visible cell meets it grown by one voxel on each side. The voxel of
/// margin absorbs what the texture unit's addressing and rounded positions may add; no length that
/// is stored counts on it. Cost: O(voxels), all cores. Fails: Internal where cancelled. Tested by:
/// proximity_cloud_test.cpp
Result<Occupancy> occupiedBlocks(const CellVisibility& visibility, int blockEdgeVoxels,
                                 const CancelToken* cancel = nullptr);

} // namespace slabcast

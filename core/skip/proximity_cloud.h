#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/cell_visibility.h"
#include "core/volume/volume.h"

namespace slabcast {

/// Euclidean distance to the closest place that the TF makes visible, per block, as one byte.
/// 0: a visible cell may be met inside the block. n > 0: the block is free, and from any point of
/// it so is every point closer than (n - 1) * quantumMm. Values above 255 are clamped; where
/// nothing is visible all are 255. Shape: blocks, x fastest; block b spans [b*e, (b+1)*e] in voxel
/// coordinates, the last one possibly beyond the box.
struct ProximityCloud {
    glm::ivec3 blocks{0};
    int blockEdgeVoxels = 4;
    double quantumMm = 1.0;
    std::vector<std::uint8_t> freeLengths;
    std::int64_t occupiedBlocks = 0;
};

/// Box-to-box lower bounds: exact Euclidean transform (separable lower envelopes) of the occupied
/// blocks grown by one block, so that the distance between two blocks counts the gap between them;
/// anisotropic spacing included, sheared axes by the shortest that they make any direction. Cost:
/// O(voxels) for occupancy, O(blocks) per axis for the transform; all cores. Stops early if
/// cancelled. Fails: InvalidArgument (block edge not 1, 2, 4 or 8), Internal where cancelled.
/// Source: Tukora 2020, section 2.3 (proximity clouds); the cell rule is ours. Tested by:
/// proximity_cloud_test.cpp
Result<ProximityCloud> buildProximityCloud(const CellVisibility& visibility,
                                           const VolumeGeometry& geometry, int blockEdgeVoxels,
                                           const CancelToken* cancel = nullptr);

} // namespace slabcast

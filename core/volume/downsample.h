#pragma once

#include "core/volume/volume.h"

namespace slabcast {

/// Box average onto ceil(dims / factor) voxels that cover the same box exactly: spacing grows by
/// dims / new dims along each axis (the factor where it divides dims), and a voxel cut by a new
/// voxel's face counts by the part inside. Integers round to nearest, halves away from zero.
/// Cost: O(voxels), all cores. Fails: InvalidArgument (a factor below 1). Tested by:
/// volume_test.cpp
Result<Volume> downsample(const Volume& volume, glm::ivec3 factor);

} // namespace slabcast

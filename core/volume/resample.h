#pragma once

#include "core/volume/volume.h"

namespace slabcast {

/// The same box with so many voxels: each new voxel's centre takes the trilinear field there,
/// clamped to the edge in the outer half voxel. Where an axis shrinks to half or less, whole
/// multiples are box-averaged first (downsample.h), so that nothing falls between the samples.
/// Integers round to nearest. Cost: O(voxels of both), all cores. Fails: InvalidArgument (an edge
/// below 1), SizeOverflow. Tested by: resample_test.cpp
Result<Volume> resample(const Volume& volume, glm::ivec3 dims);

} // namespace slabcast

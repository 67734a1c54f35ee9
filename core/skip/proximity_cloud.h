#pragma once

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/free_lengths.h"
#include "core/volume/volume.h"

namespace slabcast {

/// Euclidean distance to the closest place that the TF makes visible. Box-to-box lower bounds:
/// exact Euclidean transform (separable lower envelopes) of the occupied blocks grown by one block,
/// so that the distance between two blocks counts the gap between them; anisotropic spacing
/// included, sheared axes by the shortest that they make any direction. Cost: O(voxels) for
/// occupancy, O(blocks) per axis for the transform; all cores. Stops early if cancelled. Fails:
/// InvalidArgument (block edge not 1, 2, 4 or 8), Internal where cancelled. Source: Tukora 2020,
/// section 2.3 (proximity clouds); the cell rule is ours. Tested by: proximity_cloud_test.cpp
Result<FreeLengths> buildProximityCloud(const CellVisibility& visibility,
                                        const VolumeGeometry& geometry, int blockEdgeVoxels,
                                        const CancelToken* cancel = nullptr);

} // namespace slabcast

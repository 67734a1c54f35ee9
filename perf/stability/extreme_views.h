#pragma once

#include "perf/stability/bench.h"

namespace slabcast::stability {

// Views of the family "extreme-views" that need volumes of their own.

/// The eye inside an opaque voxel: that voxel's colour and nothing else.
void opaqueVoxelCases(Bench& bench);

/// Layers as thick as voxels, seen along an axis from so far that rays are parallel: their ends, or
/// their samples, lie on the voxels' faces.
void planesOnFacesCases(Bench& bench);

} // namespace slabcast::stability

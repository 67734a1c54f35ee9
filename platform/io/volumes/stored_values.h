#pragma once

#include <cstdint>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/volumes/voxel_source.h"

namespace slabcast {

/// How values come from what a file stores.
struct Rescaling {
    double slope = 1.0;
    double intercept = 0.0;

    bool changes() const { return slope != 1.0 || intercept != 0.0; }
};

/// Of rescaled values: the smallest of float and double that keeps what was stored.
VoxelType rescaledType(StoredType stored);

/// Makes voxels.size() values of rescaledType() of those that lie, stored, at the end of `voxels`.
void rescale(VoxelBytes& voxels, StoredType stored, const Rescaling& rescaling);

/// Makes 64-bit integers the first of int32, uint32 and double that keeps all of them, and says
/// which. The error's text lacks the file's name.
/// Fails: UnsupportedType (none does). Tested by: io_voxel_source_test.cpp
Result<VoxelType> narrow(VoxelBytes& voxels, Wide wide);

} // namespace slabcast

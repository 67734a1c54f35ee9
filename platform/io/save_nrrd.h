#pragma once

#include <filesystem>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// One .nrrd with header and uncompressed voxels, in LPS; unit and modality as keys. Voxels are
/// stored as they are, so `rescaleSlope` and `rescaleIntercept` must be 1 and 0: the format has
/// no place for them.
/// Fails: InvalidArgument (a rescaled volume), FileUnwritable. Tested by: io_nrrd_test.cpp
Result<void> saveNrrd(const std::filesystem::path& path, const Volume& volume);

} // namespace slabcast

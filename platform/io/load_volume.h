#pragma once

#include <filesystem>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"

namespace slabcast {

/// Reads NRRD (.nrrd, .nhdr), NIfTI-1 (.nii, .nii.gz), MetaImage (.mha, .mhd), DICOM (a folder,
/// or one .dcm of several frames), multi-page TIFF, folders of images (in natural order of
/// their names), and plain voxels. Voxels keep the file's type; only where the file states a
/// rescaling does the reader apply it, which may change the type. Geometry is in LPS; negative
/// spacings are folded into the direction. Images without units take the resolution tags in x
/// and y, and 1 mm in depth. What was assumed or left out is in Volume::notes. Peak memory: twice
/// the voxels. Fails: FileNotFound, FileUnreadable, FileTruncated, UnsupportedType,
/// UnsupportedDims, EmptyVolume, InvalidGeometry, SizeOverflow, EmptyFolder, AmbiguousSeries,
/// InvalidArgument (no such series or time), Cancelled. Tested by:
/// io_nrrd_test.cpp, io_nifti_test.cpp, io_meta_test.cpp, io_dicom_test.cpp, io_images_test.cpp,
/// io_raw_test.cpp
Result<Volume> loadVolume(const std::filesystem::path& path, const LoadOptions& options = {});

} // namespace slabcast

#pragma once

#include <filesystem>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"

namespace slabcast {

/// Reads NRRD (.nrrd, .nhdr), NIfTI-1 and -2 (.nii, .nii.gz, .hdr with .img), MetaImage (.mha,
/// .mhd), DICOM (a folder, or one .dcm of several frames), multi-page TIFF, folders of images (in
/// natural order of their names), and plain voxels. Voxels keep the file's type; only where the
/// file states a rescaling does the reader apply it, which may change the type. Geometry is in LPS
/// and mm; negative spacings are folded into the direction. Images that state no voxel size have 1
/// mm. What was assumed or left out is in Volume::notes.
/// The file is read by a program of its own, slabcast-read, which it may break without breaking
/// this one (LoadOptions::process). Peak memory: the voxels; twice them where a rescaling widens
/// their type. Threads: any, several at once; callbacks come on the calling one.
/// Fails: FileNotFound, FileUnreadable, FileTruncated, UnsupportedType, UnsupportedDims,
/// EmptyVolume, InvalidGeometry, SizeOverflow, EmptyFolder, AmbiguousSeries, InvalidArgument (no
/// such series or time), Cancelled. Tested by: io_apart_test.cpp, io_nrrd_test.cpp,
/// io_nifti_test.cpp, io_meta_test.cpp, io_dicom_test.cpp, io_images_test.cpp, io_raw_test.cpp
Result<Volume> loadVolume(const std::filesystem::path& path, const LoadOptions& options = {});

} // namespace slabcast

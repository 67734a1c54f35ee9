#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// How the bytes of a file without a header lie: x fastest, nothing before the first voxel.
struct RawLayout {
    glm::i64vec3 dims{0};
    VoxelType type = VoxelType::U8;
    glm::dvec3 spacingMm{1.0};
    bool bigEndian = false;
};

/// From "DIMS,TYPE,SPACING[,le|be]", as `256x256x128,uint16,1x1x1.5`.
/// Fails: InvalidArgument, UnsupportedType, UnsupportedDims, EmptyVolume, InvalidGeometry,
/// SizeOverflow.
/// Tested by: io_raw_test.cpp
Result<RawLayout> parseRawLayout(std::string_view text);

struct LoadOptions {
    std::string series;           // the UID to take where a folder holds several DICOM series
    std::optional<RawLayout> raw; // set: the file is plain voxels, whatever its name ends in
};

/// Reads NRRD (.nrrd, .nhdr), NIfTI-1 (.nii, .nii.gz), MetaImage (.mha, .mhd), DICOM (a folder,
/// or one .dcm of several frames), multi-page TIFF, folders of images (in natural order of
/// their names), and plain voxels. Voxels keep the file's type; only where the file states a
/// rescaling does the reader apply it, which may change the type. Geometry is in LPS; negative
/// spacings are folded into the direction. Images without units take the resolution tags in x
/// and y, and 1 mm in depth. Peak memory: twice the voxels.
/// Fails: FileNotFound, FileUnreadable, FileTruncated, UnsupportedType, UnsupportedDims,
/// EmptyVolume, InvalidGeometry, SizeOverflow, EmptyFolder, AmbiguousSeries, InvalidArgument
/// (no such series; more raw bytes than the layout asks for). Tested by: io_nrrd_test.cpp,
/// io_nifti_test.cpp, io_meta_test.cpp, io_dicom_test.cpp, io_images_test.cpp, io_raw_test.cpp
Result<Volume> loadVolume(const std::filesystem::path& path, const LoadOptions& options = {});

} // namespace slabcast

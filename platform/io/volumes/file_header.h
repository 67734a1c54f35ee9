#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"
#include "platform/io/volumes/voxel_source.h"

namespace slabcast {

/// Where the voxels lie, in LPS and mm; the spacing is positive.
struct Placement {
    glm::dvec3 spacingMm{1.0};
    glm::dvec3 originMm{0.0};
    glm::dmat3 direction{1.0};
};

/// From the steps between voxels in LPS and mm; column k: along voxel axis k. A step of no length
/// stays as it is, for the check of spacings to name.
Placement placementOf(const glm::dmat3& stepsMm, glm::dvec3 originMm);

/// What a volume file says about itself. Nothing is allocated, and no voxel read, before check()
/// has been through it.
struct FileHeader {
    std::vector<std::int64_t> sizes; // of the axes of space, fastest first, as written
    std::int64_t times = 1;          // as many volumes, one behind the other
    std::vector<double>
        spacings;                // of the axes of space, as written; empty where the file is silent
    std::int64_t components = 1; // numbers per voxel
    std::string typeName;        // in words
    std::optional<StoredType> type;   // unless it is one that is not read
    std::string encodingName;         // as written
    std::optional<bool> bigEndian;    // unless the file should say and does not
    VoxelSource source;               // its byte order is that of bigEndian
    Result<Placement> placement = {}; // an error counts only where sizes and type are sound
    double slope = 1.0;               // of the values: slope * stored + intercept
    double intercept = 0.0;
    std::string unit;
    Modality modality = Modality::Unknown;
    std::vector<std::string> notes; // what was assumed or left out
};

/// Takes `sizes` apart for formats whose fourth axis is time: axes of one voxel beyond the third
/// are dropped. What is neither stays in FileHeader::sizes, for check() to refuse.
void setAxes(FileHeader& header, const std::vector<std::int64_t>& sizes);

/// From the start of a file, which may lie anywhere in memory. `path`: for messages and to find
/// what the header names. `deflated`: whether `start` was inflated from the file.
/// Fails: FileUnreadable (not of this format), FileTruncated, UnsupportedDims (time is not the
/// slowest axis), InvalidGeometry (NIfTI: negative spacing). Cost: the header only. Tested by:
/// io_header_test.cpp, io_nrrd_test.cpp, io_meta_test.cpp, io_nifti_test.cpp
Result<FileHeader> parseNrrdHeader(std::string_view start, const std::filesystem::path& path);
Result<FileHeader> parseMetaHeader(std::string_view start, const std::filesystem::path& path);
Result<FileHeader> parseNiftiHeader(std::string_view start, const std::filesystem::path& path,
                                    bool deflated);

/// The same of a file.
Result<FileHeader> readNrrdHeader(const std::filesystem::path& path);
Result<FileHeader> readMetaHeader(const std::filesystem::path& path);
Result<FileHeader> readNiftiHeader(const std::filesystem::path& path);

/// Everything that can be known to be wrong before a voxel is read: afterwards all sizes fit, and
/// the files can hold as many voxels as the header asks for. Gives the bytes of one volume as
/// they are stored.
/// Fails: UnsupportedType, UnsupportedDims, EmptyVolume, SizeOverflow, InvalidGeometry,
/// FileUnreadable (encoding or byte order unknown), FileNotFound (detached data), FileTruncated.
/// Cost: looks each data file up.
Result<std::int64_t> check(const std::filesystem::path& path, const FileHeader& header);

} // namespace slabcast

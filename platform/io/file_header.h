#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

enum class DataEncoding : std::uint8_t { Raw, Deflate, Other };

/// What a volume file says about itself, read before a format library can mend it: they turn
/// spacings of zero into ones, allocate whatever the header asks for, and fill up what the file
/// does not hold.
struct FileHeader {
    std::vector<std::int64_t> sizes; // of the spatial axes, as written
    std::vector<double> spacings; // of the spatial axes, as written; empty where the file is silent
    std::int64_t components = 1;  // numbers per voxel
    std::string typeName;         // as written
    VoxelType type = VoxelType::U8;
    bool typeKnown = false;
    DataEncoding encoding = DataEncoding::Other;
    std::filesystem::path dataFile;  // empty: voxels lie in several files
    std::int64_t fileOffset = 0;     // in it, of the first voxel or of the deflated stream
    std::int64_t deflatedBytes = 0;  // 0: all that follows
    std::int64_t inflatedOffset = 0; // of the first voxel within what is inflated
    std::map<std::string, std::string> fields; // of the text formats, names in lower case
};

/// Fails: FileUnreadable (not of this format), SizeOverflow (a number that fits no integer),
/// and for NIfTI UnsupportedType (version 2). Cost: the header only.
Result<FileHeader> readNrrdHeader(const std::filesystem::path& path);
Result<FileHeader> readMetaHeader(const std::filesystem::path& path);
Result<FileHeader> readNiftiHeader(const std::filesystem::path& path);

/// Everything that can be known to be wrong before a voxel is used. A deflated stream is
/// inflated once and thrown away, for the format libraries fill up with zeros, without a word,
/// what a cut file lacks.
/// Fails: UnsupportedType, UnsupportedDims, EmptyVolume, SizeOverflow, InvalidGeometry,
/// FileNotFound (detached data), FileTruncated.
Result<void> check(const std::filesystem::path& path, const FileHeader& header);

} // namespace slabcast

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// Text: numbers between blanks or commas. Hex: two digits a byte. Other: none that is read.
enum class DataEncoding : std::uint8_t { Raw, Deflate, Text, Hex, Other };

/// 64-bit integers, which a Volume does not hold as such.
enum class Wide : std::uint8_t { No, Signed, Unsigned };

/// As a file stores voxels.
struct StoredType {
    VoxelType type = VoxelType::U8; // of wide ones: double, which is as long
    Wide wide = Wide::No;
};

/// Where the voxels of a header lie: each of the files holds as many as the others.
struct VoxelSource {
    std::vector<std::filesystem::path> files;
    DataEncoding encoding = DataEncoding::Other;
    bool bigEndian = false;
    std::int64_t headerBytes = 0; // in each file, before anything else is skipped
    std::int64_t lineSkip = 0;
    std::int64_t byteSkip = 0; // of inflated bytes where they are deflated; below 0: the voxels
                               // end with the file, or as many bytes before as it is below -1
    std::int64_t deflatedBytes = 0; // 0: all that follows
};

/// Whether the files are there and can hold `bytes` of voxels. `name`: of the header, for
/// messages.
/// Fails: FileNotFound, FileTruncated. Cost: looks each file up. Tested by:
/// io_voxel_source_test.cpp
Result<void> checkVoxelFiles(const std::string& name, const VoxelSource& source, StoredType type,
                             std::int64_t bytes);

/// Hears, every few MiB, which file is read and how much of all is done, from 0 to 1; an error ends
/// the reading.
using Going = std::function<Result<void>(const std::filesystem::path& file, double done)>;

/// Fills `voxels` with what begins `first` bytes behind the first voxel, of `bytes` in all, in the
/// machine's byte order. Deflated files are read to their end, for the checksum.
/// Fails: FileNotFound, FileTruncated (ends early, damaged), FileUnreadable (text that is no number
/// of the type), and with what `going` fails. Tested by: io_voxel_source_test.cpp
Result<void> readVoxelBytes(const std::string& name, const VoxelSource& source, StoredType type,
                            std::int64_t bytes, std::int64_t first, std::span<std::byte> voxels,
                            const Going& going = {});

} // namespace slabcast

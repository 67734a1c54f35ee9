#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// How the bytes of a file without a header lie: x fastest.
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
/// What parseRawLayout() takes.
std::string textOf(const RawLayout& layout);

/// A property by which images differ, as {"EchoTime", "20"}: DICOM's keyword or a format's word.
struct Selection {
    std::string key;
    std::string value;
};

/// From "KEY=VALUE", one or several with commas between. Fails: InvalidArgument. Tested by:
/// io_raw_test.cpp
Result<std::vector<Selection>> parseSelections(std::string_view text);

/// How far reading has come.
struct LoadProgress {
    std::filesystem::path file; // of the folder, where one is read
    double done = 0.0;          // of all that is read, from 0 to 1
};

/// What a reader in a process of its own may take before it is stopped. Plain numbers.
struct LoadLimits {
    std::int64_t memoryBytes = 0; // 0: as much as the machine has
    double stuckSeconds = 60.0;   // of computing without progress
};

enum class ReadIn : std::uint8_t {
    OwnProcess, // a file that breaks its reader breaks nothing else
    ThisProcess // for systems without processes of one's own (Android), and for debuggers
};

/// Which of several volumes to take, what to assume where the file is silent or wrong, and how to
/// read it.
struct LoadOptions {
    std::string series;            // the UID to take where a folder holds several DICOM series
    std::vector<Selection> select; // of several images at each place, those where all of these hold
    std::optional<int> time;       // of several volumes over time, the one to take, from 0
    bool resampleUneven = false;   // slices at uneven distances: brought to even ones, else refused
    std::optional<RawLayout> raw;  // set: the file is plain voxels, whatever its name ends in
    std::int64_t rawSkipBytes = 0; // of a file of plain voxels, before the first one
    std::optional<glm::dvec3> spacingMm; // in place of the file's
    std::string unit;                    // of the values, in place of the file's; empty: that

    ReadIn process = ReadIn::OwnProcess;
    LoadLimits limits;                                 // in a process of its own
    std::function<void(const LoadProgress&)> progress; // now and then, by the calling thread
    const std::atomic<bool>* cancel = nullptr;         // set: stop soon, with Cancelled
    /// Asked before voxels are read, of what is known but them: an error is what reading gives
    /// then.
    std::function<Result<void>(const Volume& header)> admit;
    std::function<VoxelBytes(std::size_t)> allocate; // what holds the voxels; empty: VoxelBytes
};

} // namespace slabcast

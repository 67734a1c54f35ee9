#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// A property that may tell images at one place apart, by DICOM's keyword.
struct DicomKey {
    const char* keyword;
    bool isTime; // orders images, so that --time can count them
};

/// Those that are looked at, the most telling first; the last counts images.
std::span<const DicomKey> dicomKeys();

/// One image of a file. What the file does not say, or not for a single frame, is empty.
struct DicomFrame {
    std::optional<glm::dvec3> positionMm; // of its first pixel's centre, LPS
    std::optional<glm::dmat2x3> axes;     // unit vectors along a row and down a column
    std::optional<glm::dvec2> spacingMm;  // along a row, down a column
    double slope = 1.0;
    double intercept = 0.0;
    std::map<std::string, std::string> properties; // of dicomKeys() and the keys asked for
};

enum class DicomCell : std::uint8_t { Integer, Float32, Float64 };

/// Stored values that mean that there is nothing; both ends belong to it.
struct DicomPadding {
    std::int64_t first = 0;
    std::int64_t last = 0;
    std::string text; // as the file gives it
};

/// Stored value i means values[i - first]; those beyond the ends mean the first or the last.
struct DicomTable {
    std::int64_t first = 0;
    std::vector<std::uint16_t> values;
};

struct DicomDataset;

/// What a DICOM file's header says, as plain data, with what its pixels are read by.
struct DicomFile {
    std::filesystem::path path;
    std::string sopClass;
    std::string sopInstance;
    std::string series;
    std::string description;
    std::string modality;
    std::string unit; // of its data values; empty where it is silent
    bool hasPixels = false;
    bool isOverTime = false; // frames are said to follow each other in time
    int rows = 0;
    int columns = 0;
    int bitsAllocated = 16;
    int bitsStored = 16;
    int highBit = 15;
    bool isSigned = false;
    DicomCell cell = DicomCell::Integer;
    std::optional<DicomPadding> padding;
    std::optional<DicomTable> table;
    std::vector<DicomFrame> frames;
    std::vector<std::string> notes;
    std::string spacingFault;   // why there is no spacing, where an element is not to be read
    std::optional<Error> fault; // why its pixels cannot be taken, should they be wanted
    std::shared_ptr<DicomDataset> dataset; // of pixels that were not taken yet (DicomPixels)

    std::int64_t frameCells() const { return std::int64_t{rows} * columns; }
};

/// The header of one file. `moreKeys` are read beside dicomKeys(). What hinders reading its pixels
/// is in `fault`.
/// Fails: FileTruncated (empty; cut within its header), FileUnreadable (not DICOM).
Result<DicomFile> openDicomFile(const std::filesystem::path& path,
                                const std::vector<std::string>& moreKeys);
/// The same of a file with DICOM's mark behind its preamble; nothing of any other.
Result<std::optional<DicomFile>> openMarkedDicomFile(const std::filesystem::path& path,
                                                     const std::vector<std::string>& moreKeys);

/// What a file without pixels is, as in "is a structured report and holds no image".
std::string describeWithoutPixels(const DicomFile& file);

} // namespace slabcast

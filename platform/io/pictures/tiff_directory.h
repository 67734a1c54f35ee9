#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace slabcast {

/// One page of a TIFF: what its directory says, by TIFF 6.0's numbers where it has numbers.
struct TiffDirectory {
    int page = 1;             // from 1, as they lie in the file
    std::uint64_t offset = 0; // of the directory, in bytes
    int width = 0;            // pixels in a stored row, at least 1
    int height = 0;           // stored rows, at least 1
    int bits = 1;             // of a sample
    int samples = 1;          // of a pixel
    int format = 1;           // 1 unsigned, 2 signed, 3 floating point, 4 unsaid, 5 and 6 complex
    int compression = 1;      // 1 none
    int photometric = 1;      // 0 the lowest value is white, 1 it is black, 3 indices of colours
    bool isPlanar = false;    // samples in planes of their own
    int orientation = 1;      // 1 to 8
    bool isTiled = false;
    bool isReduced = false; // a smaller copy of another page
    bool isMask = false;
    bool isReversed = false;            // the bits of each byte
    std::array<double, 2> resolution{}; // pixels per unit along rows and columns, 0: unsaid
    int resolutionUnit = 2;             // 1 none, 2 inch, 3 centimetre
    std::uint64_t pixelsAt = 0;         // first byte of the first strip or tile
    std::uint64_t storedBytes = 0;      // of all strips or tiles
    bool isOnePiece = false;            // whose strips lie behind one another

    /// Bytes of a stored row, of one plane.
    std::uint64_t rowBytes() const;
};

struct TiffFile {
    bool isBigEndian = false;
    std::uint64_t byteCount = 0;
    std::string description; // the first page's
    std::vector<TiffDirectory> pages;
};

/// By a file's first four bytes: TIFF or BigTIFF. The file is at its beginning again after that.
bool isTiff(std::istream& file);

/// All directories in the chain of `file`, open; those that only other tags point at are left out.
/// Every strip and tile lies within the file, and is not too short for the pixels of its page.
/// Cost: the directories. Fails: FileTruncated (cut), FileUnreadable (no TIFF, damaged),
/// EmptyVolume (a page without pixels), UnsupportedType. Tested by: io_tiff_test.cpp
Result<TiffFile> readTiffDirectories(const std::filesystem::path& path, std::ifstream file);

/// Whether the stored bytes of a page can hold so many bytes of pixels: compression has limits.
bool canHold(const TiffDirectory& page, double pixelBytes);

} // namespace slabcast

#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/pictures/tiff_directory.h"

struct tiff; // libtiff's

namespace slabcast {

/// Rows and columns after the orientation tag is applied.
glm::ivec2 turnedSize(const TiffDirectory& page);

/// Where pixels lie in an upright picture whose rows and columns were stored in another order:
/// 1 to 8 as in TIFF and EXIF. `at` is the first stored pixel's place; steps are in pixels.
struct Turn {
    std::ptrdiff_t at;
    std::ptrdiff_t rowStep;
    std::ptrdiff_t columnStep;
};
Turn turnOf(int orientation, int width, int height);

/// The type that holds a page's values as they are stored. Fails: UnsupportedType, naming the page.
Result<VoxelType> voxelTypeOf(const std::filesystem::path& path, const TiffDirectory& page);

/// What of a page is read, and how.
struct TiffPick {
    int sample = 0;         // from 0
    std::int64_t image = 0; // of those that lie behind one another without a directory of their own
    bool becomesSigned = false; // 16 bits, less 32768
};

/// Reads pages through libtiff, upright, values as they are stored; lowest-is-white turned over.
class TiffPages {
public:
    /// `file` must outlive it. Fails: FileUnreadable.
    static Result<TiffPages> open(const std::filesystem::path& path, const TiffFile& file);

    /// `target` takes as many bytes as turnedSize() and voxelTypeOf() ask for. Memory: a strip or
    /// tile. Fails: FileTruncated (damaged pixels), UnsupportedType. Tested by: io_tiff_test.cpp
    Result<void> read(const TiffDirectory& page, const TiffPick& pick, std::byte* target);

private:
    struct Handle;
    struct Close {
        void operator()(Handle* handle) const;
    };

    TiffPages(std::filesystem::path path, const TiffFile& file);
    Result<void> openLibrary();
    bool matches(const TiffDirectory& page) const;
    Result<void> readPlain(const TiffDirectory& page, const TiffPick& pick, std::byte* target);
    bool readStrips(const TiffDirectory& page, const TiffPick& pick, std::byte* target);
    bool readTiles(const TiffDirectory& page, const TiffPick& pick, std::byte* target);

    std::filesystem::path path_;
    const TiffFile* file_;
    std::unique_ptr<Handle, Close> handle_; // opened by the first page that needs it
    std::ifstream plain_;                   // likewise
};

} // namespace slabcast

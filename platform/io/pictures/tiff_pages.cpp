#include "platform/io/pictures/tiff_pages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <tiffio.h>

namespace slabcast {

/// libtiff's view of one file. Its words are for its own developers: only whether it complained is
/// kept.
struct TiffPages::Handle {
    TIFF* tiff = nullptr;
    bool isDamaged = false;
};

void TiffPages::Close::operator()(Handle* handle) const {
    if (handle->tiff != nullptr) {
        TIFFClose(handle->tiff);
    }
    delete handle;
}

namespace {

int silentError(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

/// Two decoders fill in what is missing, and only warn.
int noteWarning(TIFF*, void* damaged, const char* module, const char*, va_list) {
    const std::string_view who = module == nullptr ? "" : module;
    if (who.starts_with("JPEG") || who.starts_with("Fax")) {
        *static_cast<bool*>(damaged) = true;
    }
    return 1;
}

bool isInteger(const TiffDirectory& page) {
    return page.format == 1 || page.format == 2 || page.format == 4;
}

bool isSigned(const TiffDirectory& page) {
    return page.format == 2;
}

/// Stored as the machine holds it, once libtiff has put the bytes in order.
bool isWhole(const TiffDirectory& page) {
    return page.bits == 8 || page.bits == 16 || page.bits == 32 || page.bits == 64;
}

std::uint32_t bitsAt(const std::byte* bytes, std::size_t first, int count) {
    std::uint64_t value = 0;
    const std::size_t begin = first / 8;
    const std::size_t end = (first + count + 7) / 8;
    for (std::size_t i = begin; i < end; ++i) {
        value = value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
    }
    value >>= end * 8 - first - count;
    return static_cast<std::uint32_t>(value & ((std::uint64_t{1} << count) - 1));
}

float floatOfHalf(std::uint16_t half) {
    const int exponent = half >> 10 & 31;
    const int mantissa = half & 1023;
    const float size = exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                       : exponent == 31
                           ? (mantissa == 0 ? HUGE_VALF : NAN)
                           : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
    return (half & 0x8000) != 0 ? -size : size;
}

/// One stored row to voxels in a row.
class RowUnpacker {
public:
    RowUnpacker(const TiffDirectory& page, const TiffPick& pick, VoxelType type)
        : page_(page), becomesSigned_(pick.becomesSigned), step_(page.isPlanar ? 1 : page.samples),
          first_(page.isPlanar ? 0 : pick.sample), voxelBytes_(bytesPerVoxel(type)),
          isTurnedOver_(page.photometric == 0 && isInteger(page) && !isSigned(page)) {}

    bool copies() const {
        return isWhole(page_) && step_ == 1 && !isTurnedOver_ && !becomesSigned_ && !isHalf();
    }

    void operator()(const std::byte* row, int count, std::byte* voxels) const {
        if (isWhole(page_) && !isHalf()) {
            copyWhole(row, count, voxels);
        } else {
            for (int i = 0; i < count; ++i) {
                if (isHalf()) {
                    std::uint16_t half = 0;
                    std::memcpy(&half, row + 2 * (first_ + i * step_), 2);
                    const float value = floatOfHalf(half);
                    std::memcpy(voxels + 4 * static_cast<std::size_t>(i), &value, 4);
                } else {
                    const std::uint32_t value = oddDepth(row, first_ + i * step_);
                    std::memcpy(voxels + i * voxelBytes_, &value, voxelBytes_);
                }
            }
        }
        if (isTurnedOver_ || becomesSigned_) {
            change(voxels, count);
        }
    }

private:
    bool isHalf() const { return page_.format == 3 && page_.bits == 16; }

    void copyWhole(const std::byte* row, int count, std::byte* voxels) const {
        if (step_ == 1) {
            std::memcpy(voxels, row, count * voxelBytes_);
            return;
        }
        for (int i = 0; i < count; ++i) {
            std::memcpy(voxels + i * voxelBytes_, row + (first_ + i * step_) * voxelBytes_,
                        voxelBytes_);
        }
    }

    std::uint32_t oddDepth(const std::byte* row, std::size_t index) const {
        std::uint32_t value = 0;
        if (page_.bits == 24) { // three bytes in the machine's order, as libtiff leaves them
            std::memcpy(&value, row + 3 * index, 3);
        } else {
            value = bitsAt(row, index * page_.bits, page_.bits);
        }
        const bool isNegative = isSigned(page_) && (value >> (page_.bits - 1) & 1) != 0;
        return isNegative ? value | ~std::uint32_t{0} << page_.bits : value;
    }

    template <class T>
    void changeEach(std::byte* voxels, int count, T highest) const {
        for (int i = 0; i < count; ++i) {
            T value = 0;
            std::memcpy(&value, voxels + i * sizeof(T), sizeof(T));
            value = isTurnedOver_ ? static_cast<T>(highest - value) : value;
            value = becomesSigned_ ? static_cast<T>(value ^ 0x8000) : value;
            std::memcpy(voxels + i * sizeof(T), &value, sizeof(T));
        }
    }

    void change(std::byte* voxels, int count) const {
        const std::uint64_t highest = (std::uint64_t{1} << page_.bits) - 1;
        if (voxelBytes_ == 1) {
            changeEach<std::uint8_t>(voxels, count, static_cast<std::uint8_t>(highest));
        } else if (voxelBytes_ == 2) {
            changeEach<std::uint16_t>(voxels, count, static_cast<std::uint16_t>(highest));
        } else {
            changeEach<std::uint32_t>(voxels, count, static_cast<std::uint32_t>(highest));
        }
    }

    const TiffDirectory& page_;
    bool becomesSigned_;
    std::size_t step_;
    std::size_t first_;
    std::size_t voxelBytes_;
    bool isTurnedOver_;
};

VoxelType knownType(const TiffDirectory& page) {
    if (page.format == 3) {
        return page.bits == 64 ? VoxelType::F64 : VoxelType::F32;
    }
    if (page.bits <= 8) {
        return isSigned(page) ? VoxelType::I8 : VoxelType::U8;
    }
    if (page.bits <= 16) {
        return isSigned(page) ? VoxelType::I16 : VoxelType::U16;
    }
    return isSigned(page) ? VoxelType::I32 : VoxelType::U32;
}

/// Unpacks rows and puts them where they stand in the upright picture.
class PagePlacer {
public:
    PagePlacer(const TiffDirectory& page, const TiffPick& pick, std::byte* target)
        : unpack_(page, pick, knownType(page)), voxelBytes_(bytesPerVoxel(knownType(page))),
          turn_(turnOf(page.orientation, page.width, page.height)),
          isUpright_(page.orientation == 1), target_(target),
          line_(isUpright_ ? 0 : page.width * voxelBytes_) {}

    bool copies() const { return isUpright_ && unpack_.copies(); }

    /// `count` pixels of row `y` from `x` on.
    void put(const std::byte* row, int x, int y, int count) {
        std::byte* first = target_ + (turn_.at + y * turn_.rowStep + x * turn_.columnStep) *
                                         static_cast<std::ptrdiff_t>(voxelBytes_);
        if (isUpright_) {
            unpack_(row, count, first);
            return;
        }
        unpack_(row, count, line_.data());
        const std::ptrdiff_t step = turn_.columnStep * static_cast<std::ptrdiff_t>(voxelBytes_);
        for (int i = 0; i < count; ++i) {
            std::memcpy(first + i * step, line_.data() + i * voxelBytes_, voxelBytes_);
        }
    }

private:
    RowUnpacker unpack_;
    std::size_t voxelBytes_;
    Turn turn_;
    bool isUpright_;
    std::byte* target_;
    std::vector<std::byte> line_;
};

template <class T>
std::int64_t fieldOf(TIFF* tiff, std::uint32_t tag) {
    T value = 0;
    return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? static_cast<std::int64_t>(value) : -1;
}

/// Decoders whose output is not the pixels as they are stored.
bool isLeftAside(int compression) {
    constexpr std::array kCompressions = {COMPRESSION_OJPEG, COMPRESSION_NEXT, COMPRESSION_SGILOG,
                                          COMPRESSION_SGILOG24, COMPRESSION_PIXARLOG};
    return std::find(kCompressions.begin(), kCompressions.end(), compression) !=
           kCompressions.end();
}

void swapBytes(std::vector<std::byte>& bytes, std::size_t width) {
    for (auto at = bytes.begin(); bytes.end() - at >= static_cast<std::ptrdiff_t>(width);
         at += static_cast<std::ptrdiff_t>(width)) {
        std::reverse(at, at + static_cast<std::ptrdiff_t>(width));
    }
}

} // namespace

Turn turnOf(int orientation, int width, int height) {
    const bool isTransposed = orientation >= 5;
    const bool right = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool bottom =
        orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    const std::ptrdiff_t columns = isTransposed ? height : width;
    const std::ptrdiff_t rows = isTransposed ? width : height;
    const std::ptrdiff_t across = right ? -1 : 1;
    const std::ptrdiff_t down = bottom ? -columns : columns;
    return {.at = (right ? columns - 1 : 0) + (bottom ? (rows - 1) * columns : 0),
            .rowStep = isTransposed ? across : down,
            .columnStep = isTransposed ? down : across};
}

glm::ivec2 turnedSize(const TiffDirectory& page) {
    return page.orientation >= 5 ? glm::ivec2(page.height, page.width)
                                 : glm::ivec2(page.width, page.height);
}

Result<VoxelType> voxelTypeOf(const std::filesystem::path& path, const TiffDirectory& page) {
    const auto refused = [&](const std::string& what, const char* remedy) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: page {} has {}, which are not read; {}", path.string(),
                                page.page, what, remedy));
    };
    constexpr const char* kConvert = "convert them to an integer of 8 to 32 bits, float or double";
    if (page.format == 5 || page.format == 6) {
        return refused("complex numbers", "save their magnitude or phase alone");
    }
    if (page.format == 0 || page.bits == 0) {
        return refused("samples of several types", "save one of them alone");
    }
    if (page.photometric >= 5 && page.photometric != 32803 && page.photometric != 34892) {
        return refused("colours mixed from several numbers", "convert the images to grey");
    }
    if (page.format == 3 && page.bits != 16 && page.bits != 32 && page.bits != 64) {
        return refused(fmt::format("floating point numbers of {} bits", page.bits), kConvert);
    }
    if (page.format != 3 && (!isInteger(page) || page.bits > 32)) {
        return refused(isInteger(page) ? fmt::format("{}-bit integers", page.bits)
                                       : fmt::format("pixels of an unknown kind ({})", page.format),
                       kConvert);
    }
    if (isLeftAside(page.compression) ||
        TIFFIsCODECConfigured(static_cast<std::uint16_t>(page.compression)) == 0) {
        return refused(fmt::format("pixels compressed in a way (number {})", page.compression),
                       "save the file with LZW, Deflate or no compression");
    }
    return knownType(page);
}

TiffPages::TiffPages(std::filesystem::path path, const TiffFile& file)
    : path_(std::move(path)), file_(&file) {}

Result<TiffPages> TiffPages::open(const std::filesystem::path& path, const TiffFile& file) {
    return TiffPages(path, file);
}

/// Without its first directory, memory maps (a file that shrinks meanwhile would end the program)
/// and the cutting of large strips into small ones.
Result<void> TiffPages::openLibrary() {
    handle_ = std::unique_ptr<Handle, Close>(new Handle);
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, std::int64_t{1} << 32);
    TIFFOpenOptionsSetErrorHandlerExtR(options, silentError, nullptr);
    TIFFOpenOptionsSetWarningHandlerExtR(options, noteWarning, &handle_->isDamaged);
    handle_->tiff = TIFFOpenExt(path_.c_str(), "rhmc", options);
    TIFFOpenOptionsFree(options);
    if (handle_->tiff == nullptr) {
        return fail(
            ErrorCode::FileUnreadable,
            fmt::format("{}: cannot be opened as a TIFF; check its permissions", path_.string()));
    }
    return {};
}

/// A file may list a tag twice, and the library must not understand another page than was checked.
bool TiffPages::matches(const TiffDirectory& page) const {
    TIFF* tiff = handle_->tiff;
    const int planar = page.isPlanar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG;
    return fieldOf<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH) == page.width &&
           fieldOf<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH) == page.height &&
           fieldOf<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE) == page.bits &&
           fieldOf<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL) == page.samples &&
           fieldOf<std::uint16_t>(tiff, TIFFTAG_COMPRESSION) == page.compression &&
           (fieldOf<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG) == planar || page.samples == 1) &&
           (TIFFIsTiled(tiff) != 0) == page.isTiled &&
           (page.isTiled || TIFFScanlineSize64(tiff) == page.rowBytes());
}

Result<void> TiffPages::read(const TiffDirectory& page, const TiffPick& pick, std::byte* target) {
    if (pick.image > 0) {
        return readPlain(page, pick, target);
    }
    if (!handle_) {
        if (const Result<void> opened = openLibrary(); !opened) {
            return opened;
        }
    }
    const bool isRead =
        TIFFSetSubDirectory(handle_->tiff, page.offset) == 1 && matches(page) &&
        (page.isTiled ? readTiles(page, pick, target) : readStrips(page, pick, target));
    if (!isRead || handle_->isDamaged) {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("{}: the pixels of page {} end early or are damaged; fetch the "
                                "file again",
                                path_.string(), page.page));
    }
    return {};
}

Result<void> TiffPages::readPlain(const TiffDirectory& page, const TiffPick& pick,
                                  std::byte* target) {
    if (!plain_.is_open()) {
        plain_.open(path_, std::ios::binary);
    }
    std::vector<std::byte> row(page.rowBytes());
    const std::uint64_t pageBytes = page.rowBytes() * page.height;
    plain_.seekg(static_cast<std::streamoff>(page.pixelsAt + pick.image * pageBytes));
    PagePlacer place(page, pick, target);
    for (int y = 0; y < page.height; ++y) {
        if (!plain_.read(reinterpret_cast<char*>(row.data()),
                         static_cast<std::streamsize>(row.size()))) {
            return fail(ErrorCode::FileTruncated,
                        fmt::format("{}: the file ends before its image {} does; fetch it again",
                                    path_.string(), pick.image + 1));
        }
        const bool isInOrder = file_->isBigEndian == (std::endian::native == std::endian::big);
        if (!isInOrder && (isWhole(page) || page.bits == 24)) {
            swapBytes(row, page.bits / 8);
        }
        place.put(row.data(), 0, y, page.width);
    }
    return {};
}

bool TiffPages::readStrips(const TiffDirectory& page, const TiffPick& pick, std::byte* target) {
    TIFF* tiff = handle_->tiff;
    const std::int64_t stated = fieldOf<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP);
    if (stated < 1) {
        return false;
    }
    const int rowsPerStrip = static_cast<int>(std::min<std::int64_t>(stated, page.height));
    const int strips = (page.height + rowsPerStrip - 1) / rowsPerStrip;
    const int first = page.isPlanar ? pick.sample * strips : 0;
    const auto rowBytes = static_cast<std::int64_t>(page.rowBytes());
    PagePlacer place(page, pick, target);
    std::vector<std::byte> strip(place.copies() ? 0 : rowBytes * rowsPerStrip);
    for (int i = 0; i < strips; ++i) {
        const int y = i * rowsPerStrip;
        const int rows = std::min(rowsPerStrip, page.height - y);
        std::byte* pixels = place.copies() ? target + y * rowBytes : strip.data();
        if (TIFFReadEncodedStrip(tiff, first + i, pixels, rows * rowBytes) != rows * rowBytes) {
            return false;
        }
        for (int row = 0; row < rows && !place.copies(); ++row) {
            place.put(pixels + row * rowBytes, 0, y + row, page.width);
        }
    }
    return true;
}

bool TiffPages::readTiles(const TiffDirectory& page, const TiffPick& pick, std::byte* target) {
    TIFF* tiff = handle_->tiff;
    const std::int64_t width = fieldOf<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH);
    const std::int64_t height = fieldOf<std::uint32_t>(tiff, TIFFTAG_TILELENGTH);
    if (width < 1 || height < 1) {
        return false;
    }
    TiffDirectory tile = page;
    tile.width = static_cast<int>(std::min<std::int64_t>(width, 1 << 30));
    const auto rowBytes = static_cast<std::int64_t>(tile.rowBytes());
    const auto tileBytes = static_cast<std::int64_t>(TIFFTileSize64(tiff));
    if (width != tile.width || tileBytes != rowBytes * height ||
        !canHold(page, static_cast<double>(rowBytes) * static_cast<double>(height))) {
        return false;
    }
    PagePlacer place(page, pick, target);
    std::vector<std::byte> pixels(tileBytes);
    for (std::int64_t y = 0; y < page.height; y += height) {
        for (std::int64_t x = 0; x < page.width; x += width) {
            const std::uint32_t number =
                TIFFComputeTile(tiff, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                0, static_cast<std::uint16_t>(page.isPlanar ? pick.sample : 0));
            if (TIFFReadEncodedTile(tiff, number, pixels.data(), tileBytes) != tileBytes) {
                return false;
            }
            const auto rows = static_cast<int>(std::min(height, page.height - y));
            const auto columns = static_cast<int>(std::min(width, page.width - x));
            for (int row = 0; row < rows; ++row) {
                place.put(pixels.data() + row * rowBytes, static_cast<int>(x),
                          static_cast<int>(y) + row, columns);
            }
        }
    }
    return true;
}

} // namespace slabcast

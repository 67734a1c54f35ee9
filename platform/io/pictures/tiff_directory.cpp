#include "platform/io/pictures/tiff_directory.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace slabcast {

namespace {

// TIFF 6.0, sections 8, 15 and 19.
enum Tag : std::uint64_t {
    kSubfile = 254,
    kOldSubfile = 255,
    kWidth = 256,
    kHeight = 257,
    kBits = 258,
    kCompression = 259,
    kPhotometric = 262,
    kFillOrder = 266,
    kDescription = 270,
    kStripOffsets = 273,
    kOrientation = 274,
    kSamples = 277,
    kStripByteCounts = 279,
    kXResolution = 282,
    kYResolution = 283,
    kPlanar = 284,
    kResolutionUnit = 296,
    kTileOffsets = 324,
    kTileByteCounts = 325,
    kFormat = 339
};

enum Type : std::uint64_t { kShort = 3, kRational = 5, kFloat = 11, kDouble = 12 };

int bytesOfType(std::uint64_t type) {
    constexpr std::array<int, 19> kBytes = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4,
                                            8, 4, 8, 4, 0, 0, 8, 8, 8};
    return type < kBytes.size() ? kBytes[type] : 0;
}

/// Sizes in bytes of what differs between TIFF (6.0, section 2) and BigTIFF.
struct Widths {
    std::uint64_t firstDirectoryAt;
    int offset;
    int entryCount;
    int entry;
};

constexpr Widths kClassic = {4, 4, 2, 12};
constexpr Widths kBig = {8, 8, 8, 20};

using Bytes = std::vector<unsigned char>;

struct Entry {
    std::uint64_t tag;
    std::uint64_t type;
    std::uint64_t count;
    Bytes here;          // as many bytes as an offset has
    std::uint64_t there; // the same as a number
};

class Parser {
public:
    Parser(const std::filesystem::path& path, std::ifstream file)
        : path_(path), file_(std::move(file)) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(path, error);
        result_.byteCount = error ? 0 : size;
        budget_ = 2.0 * static_cast<double>(result_.byteCount) + 65536.0;
        Bytes mark;
        if (take(0, 4, mark)) {
            result_.isBigEndian = mark[0] == 'M';
            const std::uint64_t version = number(mark, 2, 2);
            widths_ = version == 43 ? kBig : kClassic;
            isTiff_ = mark[0] == mark[1] && (mark[0] == 'I' || mark[0] == 'M') &&
                      (version == 42 || version == 43);
        }
    }

    bool isTiff() const { return isTiff_; }

    Result<TiffFile> parse() {
        Bytes first;
        if (!take(widths_.firstDirectoryAt, widths_.offset, first)) {
            return cut(1);
        }
        std::set<std::uint64_t> seen;
        std::uint64_t at = number(first, 0, widths_.offset);
        while (at != 0) {
            if (!seen.insert(at).second) {
                return damaged("its pages follow one another in a circle");
            }
            const Result<std::uint64_t> next = takeDirectory(at);
            if (!next) {
                return tl::unexpected(next.error());
            }
            at = *next;
        }
        if (result_.pages.empty()) {
            return damaged("it lists no pages");
        }
        return std::move(result_);
    }

private:
    tl::unexpected<Error> cut(int page) const {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("{}: the file ends before its page {} does; fetch it again",
                                path_.string(), page));
    }

    tl::unexpected<Error> damaged(const std::string& why) const {
        return fail(
            ErrorCode::FileUnreadable,
            fmt::format("{}: {}: the file is damaged; fetch it again, or save it again from "
                        "the program that wrote it",
                        path_.string(), why));
    }

    bool take(std::uint64_t position, std::uint64_t count, Bytes& bytes) {
        budget_ -= static_cast<double>(count);
        if (position > result_.byteCount || count > result_.byteCount - position || budget_ < 0.0) {
            return false;
        }
        bytes.resize(count);
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(position));
        file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
        return static_cast<std::uint64_t>(file_.gcount()) == count;
    }

    std::uint64_t number(const Bytes& bytes, std::size_t at, int width) const {
        std::uint64_t value = 0;
        for (int i = 0; i < width; ++i) {
            value = value << 8 | bytes[at + (result_.isBigEndian ? i : width - 1 - i)];
        }
        return value;
    }

    std::optional<Bytes> content(const Entry& entry) {
        const auto width = static_cast<std::uint64_t>(bytesOfType(entry.type));
        if (width == 0 || entry.count > result_.byteCount) {
            return width == 0 ? std::optional<Bytes>(Bytes()) : std::nullopt;
        }
        if (entry.count * width <= entry.here.size()) {
            return Bytes(entry.here.begin(),
                         entry.here.begin() + static_cast<std::ptrdiff_t>(entry.count * width));
        }
        Bytes bytes;
        return take(entry.there, entry.count * width, bytes) ? std::optional(std::move(bytes))
                                                             : std::nullopt;
    }

    /// Nothing where the file ends before.
    std::optional<std::vector<std::uint64_t>> numbers(const Entry& entry) {
        const std::optional<Bytes> bytes = content(entry);
        if (!bytes) {
            return std::nullopt;
        }
        const int width = bytesOfType(entry.type);
        std::vector<std::uint64_t> all;
        for (std::size_t at = 0; width > 0 && at + width <= bytes->size(); at += width) {
            all.push_back(number(*bytes, at, width));
        }
        return all;
    }

    double real(const Entry& entry) {
        const std::optional<Bytes> bytes = content(entry);
        const int width = bytesOfType(entry.type);
        if (!bytes || static_cast<int>(bytes->size()) < std::max(width, 1)) {
            return 0.0;
        }
        if (entry.type == kRational) {
            const auto above = static_cast<double>(number(*bytes, 0, 4));
            const auto below = static_cast<double>(number(*bytes, 4, 4));
            return below > 0.0 ? above / below : 0.0;
        }
        const std::uint64_t plain = number(*bytes, 0, width);
        return entry.type == kFloat    ? std::bit_cast<float>(static_cast<std::uint32_t>(plain))
               : entry.type == kDouble ? std::bit_cast<double>(plain)
                                       : static_cast<double>(plain);
    }

    /// Where the next one is, 0: nowhere.
    Result<std::uint64_t> takeDirectory(std::uint64_t at) {
        const int page = static_cast<int>(result_.pages.size()) + 1;
        Bytes bytes;
        if (!take(at, widths_.entryCount, bytes)) {
            return cut(page);
        }
        const std::uint64_t count = number(bytes, 0, widths_.entryCount);
        const std::uint64_t length = count * widths_.entry;
        if (count > result_.byteCount / widths_.entry ||
            !take(at + widths_.entryCount, length + widths_.offset, bytes)) {
            return cut(page);
        }
        TiffDirectory directory;
        directory.page = page;
        directory.offset = at;
        std::vector<std::uint64_t> offsets;
        std::vector<std::uint64_t> byteCounts;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::size_t begin = i * widths_.entry;
            const std::size_t value = begin + 4 + widths_.offset;
            const Entry entry{
                .tag = number(bytes, begin, 2),
                .type = number(bytes, begin + 2, 2),
                .count = number(bytes, begin + 4, widths_.offset),
                .here = Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(value),
                              bytes.begin() + static_cast<std::ptrdiff_t>(value + widths_.offset)),
                .there = number(bytes, value, widths_.offset)};
            if (!takeEntry(entry, directory, offsets, byteCounts)) {
                return budget_ < 0.0 ? Result<std::uint64_t>(
                                           damaged(fmt::format("page {} lists too much", page)))
                                     : cut(page);
            }
        }
        if (const Result<void> placed = place(directory, offsets, byteCounts); !placed) {
            return tl::unexpected(placed.error());
        }
        result_.pages.push_back(directory);
        return number(bytes, length, widths_.offset);
    }

    /// False where the file ends before what is needed.
    bool takeEntry(const Entry& entry, TiffDirectory& directory,
                   std::vector<std::uint64_t>& offsets, std::vector<std::uint64_t>& byteCounts) {
        if (entry.tag == kXResolution || entry.tag == kYResolution) {
            directory.resolution[entry.tag - kXResolution] = real(entry);
            return true;
        }
        if (entry.tag == kDescription) {
            if (std::optional<Bytes> text = result_.pages.empty() ? content(entry) : Bytes()) {
                result_.description.append(text->begin(), text->end());
            }
            return true;
        }
        constexpr std::array<std::uint64_t, 16> kNeeded = {
            kSubfile,      kOldSubfile,     kWidth,       kHeight,
            kBits,         kCompression,    kPhotometric, kFillOrder,
            kStripOffsets, kOrientation,    kSamples,     kStripByteCounts,
            kPlanar,       kResolutionUnit, kTileOffsets, kTileByteCounts};
        if (entry.tag != kFormat &&
            std::find(kNeeded.begin(), kNeeded.end(), entry.tag) == kNeeded.end()) {
            return true;
        }
        std::optional<std::vector<std::uint64_t>> all = numbers(entry);
        if (!all) {
            return false;
        }
        if (entry.tag == kStripOffsets || entry.tag == kTileOffsets) {
            directory.isTiled = entry.tag == kTileOffsets;
            offsets = std::move(*all);
        } else if (entry.tag == kStripByteCounts || entry.tag == kTileByteCounts) {
            byteCounts = std::move(*all);
        } else if (!all->empty()) {
            setNumber(entry.tag, *all, directory);
        }
        return true;
    }

    static void setNumber(std::uint64_t tag, const std::vector<std::uint64_t>& all,
                          TiffDirectory& directory) {
        constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
        const int value = static_cast<int>(std::min(all.front(), kMost));
        const bool differ =
            std::any_of(all.begin(), all.end(), [&](std::uint64_t each) { return each != all[0]; });
        switch (tag) {
        case kSubfile:
            directory.isReduced = directory.isReduced || (value & 1) != 0;
            directory.isMask = (value & 4) != 0;
            break;
        case kOldSubfile:
            directory.isReduced = directory.isReduced || value == 2;
            break;
        case kWidth:
            directory.width = value;
            break;
        case kHeight:
            directory.height = value;
            break;
        case kBits:
            directory.bits = differ ? 0 : value;
            break;
        case kCompression:
            directory.compression = value;
            break;
        case kPhotometric:
            directory.photometric = value;
            break;
        case kFillOrder:
            directory.isReversed = value == 2;
            break;
        case kOrientation:
            directory.orientation = value >= 1 && value <= 8 ? value : 1;
            break;
        case kSamples:
            directory.samples = value;
            break;
        case kPlanar:
            directory.isPlanar = value == 2;
            break;
        case kResolutionUnit:
            directory.resolutionUnit = value;
            break;
        default: // kFormat
            directory.format = differ ? 0 : value;
        }
    }

    Result<void> place(TiffDirectory& page, const std::vector<std::uint64_t>& offsets,
                       const std::vector<std::uint64_t>& byteCounts) const {
        if (page.width == 0 || page.height == 0) {
            return fail(ErrorCode::EmptyVolume,
                        fmt::format("{}: page {} has no pixels; take it out of the file",
                                    path_.string(), page.page));
        }
        if (offsets.empty() || page.samples < 1 || page.samples > 65535) {
            return damaged(fmt::format("page {} does not say where its pixels are", page.page));
        }
        page.pixelsAt = offsets.front();
        page.isOnePiece = !page.isTiled && !(page.isPlanar && page.samples > 1);
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            const std::uint64_t count = i < byteCounts.size() ? byteCounts[i] : 0;
            if (offsets[i] > result_.byteCount || count > result_.byteCount - offsets[i]) {
                return cut(page.page);
            }
            page.isOnePiece = page.isOnePiece && offsets[i] == page.pixelsAt + page.storedBytes;
            page.storedBytes += count;
        }
        // Some writers leave the count of a single strip out, or say too little.
        if (page.compression == 1 && offsets.size() == 1 && !page.isTiled) {
            page.storedBytes = std::max(page.storedBytes, result_.byteCount - page.pixelsAt);
        }
        page.storedBytes = std::min(page.storedBytes, result_.byteCount);
        const double planes = page.isPlanar ? page.samples : 1;
        if (!canHold(page, static_cast<double>(page.rowBytes()) * page.height * planes)) {
            return cut(page.page);
        }
        return {};
    }

    std::filesystem::path path_;
    std::ifstream file_;
    TiffFile result_;
    Widths widths_ = kClassic;
    double budget_ =
        0.0; // bytes that may still be read: arrays that share their bytes come to an end
    bool isTiff_ = false;
};

} // namespace

std::uint64_t TiffDirectory::rowBytes() const {
    const std::uint64_t samplesInRow = static_cast<std::uint64_t>(width) * (isPlanar ? 1 : samples);
    return (samplesInRow * std::min(bits, 64) + 7) / 8;
}

bool canHold(const TiffDirectory& page, double pixelBytes) {
    double most = 0.0;
    switch (page.compression) {
    case 1: // none
        return pixelBytes <= static_cast<double>(page.storedBytes);
    case 2:
    case 3:
    case 4:     // fax: a bit for a row
    case 34661: // JBIG
        most = 8.0 * static_cast<double>(page.rowBytes()) + 64.0;
        break;
    case 5: // LZW
        most = 4096.0;
        break;
    case 7: // JPEG
        most = 2048.0;
        break;
    case 8:
    case 32946: // Deflate
        most = 1100.0;
        break;
    case 32773: // PackBits
        most = 64.0;
        break;
    case 34925: // LZMA
        most = 8000.0;
        break;
    default: // Zstandard, LERC, WebP
        most = 40000.0;
    }
    return pixelBytes <= most * static_cast<double>(page.storedBytes);
}

bool isTiff(std::istream& file) {
    std::array<char, 4> mark{};
    file.read(mark.data(), mark.size());
    file.clear();
    file.seekg(0);
    const std::string_view start(mark.data(), mark.size());
    return start == std::string_view("II*\0", 4) || start == std::string_view("MM\0*", 4) ||
           start == std::string_view("II+\0", 4) || start == std::string_view("MM\0+", 4);
}

Result<TiffFile> readTiffDirectories(const std::filesystem::path& path, std::ifstream file) {
    Parser parser(path, std::move(file));
    if (!parser.isTiff()) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: is no TIFF; check what the file holds", path.string()));
    }
    return parser.parse();
}

} // namespace slabcast

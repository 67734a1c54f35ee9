#include "platform/io/tiff_extent.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <map>
#include <vector>

namespace slabcast {

namespace {

// TIFF 6.0, section 8 and 15: where the pixels of a page lie.
enum Tag : std::uint64_t {
    kStripOffsets = 273,
    kStripByteCounts = 279,
    kTileOffsets = 324,
    kTileByteCounts = 325
};

/// Sizes in bytes of what differs between TIFF (6.0, section 2) and BigTIFF.
struct Widths {
    std::uint64_t firstDirectoryAt;
    int offset;
    int entryCount;
    int entry;
};

constexpr Widths kClassic = {4, 4, 2, 12};
constexpr Widths kBig = {8, 8, 8, 20};

class TiffFile {
public:
    explicit TiffFile(const std::filesystem::path& path)
        : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
        std::array<char, 2> order{};
        file_.read(order.data(), order.size());
        const bool little = order == std::array{'I', 'I'};
        const bool big = order == std::array{'M', 'M'};
        bigEndian_ = big;
        const std::uint64_t version = little || big ? number(2, 2) : 0;
        isTiff_ = version == 42 || version == 43;
        widths_ = version == 43 ? kBig : kClassic;
    }

    bool isTiff() const { return isTiff_; }

    bool isWhole() {
        std::uint64_t directory = number(widths_.firstDirectoryAt, widths_.offset);
        std::uint64_t left = size_; // no more directories than bytes: a chain in a circle ends, too
        while (directory != 0 && !past_ && left-- > 0) {
            const std::uint64_t entries = number(directory, widths_.entryCount);
            const std::uint64_t first = directory + widths_.entryCount;
            if (entries > size_ / widths_.entry || !pixelsAreInside(first, entries)) {
                return false;
            }
            directory = number(first + entries * widths_.entry, widths_.offset);
        }
        return !past_;
    }

private:
    /// Zero, and remembered, where the file has ended.
    std::uint64_t number(std::uint64_t position, int width) {
        std::array<unsigned char, 8> bytes{};
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(std::min(position, size_)));
        file_.read(reinterpret_cast<char*>(bytes.data()), width);
        past_ = past_ || file_.gcount() != width;
        if (bigEndian_) {
            std::reverse(bytes.begin(), bytes.begin() + width);
        }
        std::uint64_t value = 0;
        for (int i = width - 1; i >= 0; --i) {
            value = value << 8 | bytes[i];
        }
        return value;
    }

    std::vector<std::uint64_t> values(std::uint64_t entry) {
        static const std::map<std::uint64_t, int> kWidthOfType = {{3, 2}, {4, 4}, {16, 8}};
        const auto type = kWidthOfType.find(number(entry + 2, 2));
        const std::uint64_t count = number(entry + 4, widths_.offset);
        if (type == kWidthOfType.end() || count > size_) {
            past_ = past_ || count > size_;
            return {};
        }
        const std::uint64_t here = entry + 4 + widths_.offset;
        const bool fits = count * type->second <= static_cast<std::uint64_t>(widths_.offset);
        const std::uint64_t begin = fits ? here : number(here, widths_.offset);
        std::vector<std::uint64_t> all;
        for (std::uint64_t i = 0; i < count && !past_; ++i) {
            all.push_back(number(begin + i * type->second, type->second));
        }
        return all;
    }

    bool pixelsAreInside(std::uint64_t firstEntry, std::uint64_t entries) {
        std::vector<std::uint64_t> offsets;
        std::vector<std::uint64_t> byteCounts;
        for (std::uint64_t i = 0; i < entries && !past_; ++i) {
            const std::uint64_t entry = firstEntry + i * widths_.entry;
            const std::uint64_t tag = number(entry, 2);
            if (tag == kStripOffsets || tag == kTileOffsets) {
                offsets = values(entry);
            } else if (tag == kStripByteCounts || tag == kTileByteCounts) {
                byteCounts = values(entry);
            }
        }
        for (std::size_t i = 0; i < std::min(offsets.size(), byteCounts.size()); ++i) {
            past_ = past_ || offsets[i] > size_ || byteCounts[i] > size_ - offsets[i];
        }
        return !past_;
    }

    std::ifstream file_;
    std::uint64_t size_;
    Widths widths_ = kClassic;
    bool bigEndian_ = false;
    bool isTiff_ = false;
    bool past_ = false;
};

} // namespace

bool isWholeTiff(const std::filesystem::path& path) {
    TiffFile file(path);
    return !file.isTiff() || file.isWhole();
}

} // namespace slabcast

#include "platform/io/pictures/image_extent.h"

#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace slabcast {

namespace {

/// A place in the bytes of a file.
class Cursor {
public:
    explicit Cursor(std::string_view bytes, std::uint64_t at = 0) : bytes_(bytes), at_(at) {}

    void skip(std::uint64_t count) { at_ += count; }

    /// Nothing at the end of the file.
    std::optional<int> byte() {
        return at_ < bytes_.size() ? std::optional<int>(static_cast<unsigned char>(bytes_[at_++]))
                                   : std::nullopt;
    }

    std::optional<std::uint32_t> number(int bytes) {
        std::uint32_t value = 0;
        for (int i = 0; i < bytes; ++i) {
            const std::optional<int> next = byte();
            if (!next) {
                return std::nullopt;
            }
            value = value << 8 | static_cast<std::uint32_t>(*next);
        }
        return value;
    }

private:
    std::string_view bytes_;
    std::uint64_t at_;
};

/// Past the next marker, whose second byte it gives; pixels in between are passed over.
std::optional<int> nextMarker(Cursor& file) {
    std::optional<int> byte = file.byte();
    while (byte) {
        while (byte && *byte != 0xFF) {
            byte = file.byte();
        }
        while (byte && *byte == 0xFF) {
            byte = file.byte();
        }
        if (byte && *byte != 0) { // FF 00 is a pixel's byte
            return byte;
        }
    }
    return std::nullopt;
}

/// ISO 10918-1, annex B: markers, most of them with a length, until EOI.
bool isWholeJpeg(std::string_view bytes) {
    constexpr int kEoi = 0xD9;
    Cursor file(bytes, 2);
    while (const std::optional<int> marker = nextMarker(file)) {
        if (*marker == kEoi) {
            return true;
        }
        const bool isAlone = *marker == 0x01 || (*marker >= 0xD0 && *marker <= 0xD8);
        if (isAlone) {
            continue;
        }
        const std::optional<std::uint32_t> length = file.number(2);
        if (!length || *length < 2) {
            return false;
        }
        file.skip(*length - 2);
    }
    return false;
}

/// Chunks of a length, a name, as many bytes and a sum, until IEND.
bool isWholePng(std::string_view bytes) {
    for (std::uint64_t at = 8; at + 12 <= bytes.size();) {
        Cursor file(bytes, at);
        const std::optional<std::uint32_t> length = file.number(4);
        const std::optional<std::uint32_t> name = file.number(4);
        if (!length || !name) {
            return false;
        }
        at += 12 + std::uint64_t{*length};
        if (*name == 0x49454E44) { // IEND
            return at <= bytes.size();
        }
    }
    return false;
}

/// IHDR comes first: its bit depth and colour type, of which 0 is grey.
int highestOfPng(std::string_view bytes) {
    Cursor file(bytes, 24);
    const int bits = file.byte().value_or(8);
    const int colour = file.byte().value_or(2);
    return colour == 0 && bits < 8 ? (1 << bits) - 1 : 0;
}

/// Words until the third number; '#' begins a comment that ends with the line.
int highestOfPgm(std::string_view bytes) {
    constexpr std::size_t kMostHeader = 65536;
    std::istringstream file{std::string(bytes.substr(2, kMostHeader))};
    int value = 0;
    for (int i = 0; i < 3 && file; ++i) {
        while (file >> std::ws && file.peek() == '#') {
            std::string comment;
            std::getline(file, comment);
        }
        file >> value;
    }
    return file && value > 0 && value < 65535 && value != 255 ? value : 0;
}

} // namespace

ImageExtent extentOf(std::string_view bytes) {
    if (bytes.starts_with("\xFF\xD8\xFF")) {
        return {.isWhole = isWholeJpeg(bytes), .isJpeg = true};
    }
    if (bytes.starts_with("\x89PNG")) {
        return {.isWhole = isWholePng(bytes), .highest = highestOfPng(bytes)};
    }
    if (bytes.starts_with("P5") || bytes.starts_with("P2")) {
        return {.highest = highestOfPgm(bytes)};
    }
    return {};
}

} // namespace slabcast

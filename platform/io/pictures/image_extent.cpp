#include "platform/io/pictures/image_extent.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace slabcast {

namespace {

/// Nothing at the end of the file.
std::optional<int> nextByte(std::istream& file) {
    const int byte = file.rdbuf()->sbumpc();
    return byte == std::char_traits<char>::eof() ? std::nullopt : std::optional(byte);
}

std::optional<std::uint32_t> nextNumber(std::istream& file, int bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) {
        const std::optional<int> byte = nextByte(file);
        if (!byte) {
            return std::nullopt;
        }
        value = value << 8 | static_cast<std::uint32_t>(*byte);
    }
    return value;
}

/// Past the next marker, whose second byte it gives; pixels in between are passed over.
std::optional<int> nextMarker(std::istream& file) {
    std::optional<int> byte = nextByte(file);
    while (byte) {
        while (byte && *byte != 0xFF) {
            byte = nextByte(file);
        }
        while (byte && *byte == 0xFF) {
            byte = nextByte(file);
        }
        if (byte && *byte != 0) { // FF 00 is a pixel's byte
            return byte;
        }
    }
    return std::nullopt;
}

/// ISO 10918-1, annex B: markers, most of them with a length, until EOI.
bool isWholeJpeg(std::istream& file) {
    constexpr int kEoi = 0xD9;
    while (const std::optional<int> marker = nextMarker(file)) {
        if (*marker == kEoi) {
            return true;
        }
        const bool isAlone = *marker == 0x01 || (*marker >= 0xD0 && *marker <= 0xD8);
        if (isAlone) {
            continue;
        }
        const std::optional<std::uint32_t> length = nextNumber(file, 2);
        if (!length || *length < 2) {
            return false;
        }
        file.seekg(*length - 2, std::ios::cur);
    }
    return false;
}

/// Chunks of a length, a name, as many bytes and a sum, until IEND.
bool isWholePng(std::istream& file, std::uint64_t size) {
    for (std::uint64_t at = 8; at + 12 <= size;) {
        file.seekg(static_cast<std::streamoff>(at));
        const std::optional<std::uint32_t> length = nextNumber(file, 4);
        const std::optional<std::uint32_t> name = nextNumber(file, 4);
        if (!length || !name) {
            return false;
        }
        at += 12 + std::uint64_t{*length};
        if (*name == 0x49454E44) { // IEND
            return at <= size;
        }
    }
    return false;
}

/// IHDR comes first: its bit depth and colour type, of which 0 is grey.
int highestOfPng(std::istream& file) {
    file.seekg(24);
    const int bits = nextByte(file).value_or(8);
    const int colour = nextByte(file).value_or(2);
    return colour == 0 && bits < 8 ? (1 << bits) - 1 : 0;
}

/// Words until the third number; '#' begins a comment that ends with the line.
int highestOfPgm(std::istream& file) {
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

ImageExtent extentOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 8> mark{};
    file.read(mark.data(), mark.size());
    const std::string_view begin(mark.data(), static_cast<std::size_t>(file.gcount()));
    file.clear();
    if (begin.starts_with("\xFF\xD8\xFF")) {
        file.seekg(2);
        return {.isWhole = isWholeJpeg(file), .isJpeg = true};
    }
    if (begin.starts_with("\x89PNG")) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(path, error);
        return {.isWhole = !error && isWholePng(file, size), .highest = highestOfPng(file)};
    }
    if (begin.starts_with("P5") || begin.starts_with("P2")) {
        file.seekg(2);
        return {.highest = highestOfPgm(file)};
    }
    return {};
}

} // namespace slabcast

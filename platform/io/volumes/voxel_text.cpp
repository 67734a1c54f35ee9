#include "platform/io/volumes/voxel_text.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "platform/io/volumes/text_header.h"

namespace slabcast {

namespace {

constexpr std::size_t kLongestNumber = 400; // a double in full takes fewer
constexpr int kEnd = std::char_traits<char>::eof();

bool isBetween(int c) {
    return c == ' ' || c == ',' || (c >= '\t' && c <= '\r');
}

/// Numbers beyond the range become infinite or zero, as they do in double.
std::optional<double> realOf(const std::string& word) {
    const char* begin = word.c_str() + (word.starts_with('+') ? 1 : 0);
    const char* end = word.c_str() + word.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (stop != end || error == std::errc::invalid_argument) {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range) {
        const bool tiny = word.find("e-") != std::string::npos ||
                          word.find("E-") != std::string::npos || word.find("0.0") <= 1;
        value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
        value = word.starts_with('-') ? -value : value;
    }
    return value;
}

template <class T>
std::optional<T> numberOf(const std::string& word) {
    if constexpr (std::is_floating_point_v<T>) {
        const std::optional<double> value = realOf(word);
        return value ? std::optional(static_cast<T>(*value)) : std::nullopt;
    } else {
        const char* begin = word.c_str() + (word.starts_with('+') ? 1 : 0);
        const char* end = word.c_str() + word.size();
        T value = 0;
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (stop == end && error == std::errc()) {
            return value;
        }
        const std::optional<double> real = realOf(word); // a whole number written as "3.0"
        constexpr double kBeyond = 2.0 * (std::numeric_limits<T>::max() / 2 + 1);
        const bool whole = real && std::trunc(*real) == *real && *real < kBeyond &&
                           *real >= static_cast<double>(std::numeric_limits<T>::min());
        return whole && stop != end ? std::optional(static_cast<T>(*real)) : std::nullopt;
    }
}

int hexDigit(int c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const int lower = c | 0x20;
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

} // namespace

/// A word is cut where it is too long for a number.
Result<void> TextVoxels::nextWord() {
    std::streambuf& buffer = *stream_.rdbuf();
    word_.clear();
    int c = buffer.sbumpc();
    while (isBetween(c)) {
        c = buffer.sbumpc();
    }
    for (; c != kEnd && !isBetween(c) && word_.size() <= kLongestNumber; c = buffer.sbumpc()) {
        word_ += static_cast<char>(c);
    }
    if (word_.empty()) {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("ends after {} voxels; fetch the file again or correct the sizes "
                                "in the header",
                                count_));
    }
    ++count_;
    return {};
}

Result<void> TextVoxels::skip(std::int64_t count) {
    Result<void> there;
    for (std::int64_t i = 0; i < count && there; ++i) {
        there = nextWord();
    }
    return there;
}

template <class T>
Result<void> TextVoxels::takeNumbers(const char* typeName, std::span<std::byte> voxels) {
    for (std::size_t at = 0; at + sizeof(T) <= voxels.size(); at += sizeof(T)) {
        if (const Result<void> there = nextWord(); !there) {
            return there;
        }
        const std::optional<T> value = numberOf<T>(word_);
        if (!value) {
            return fail(ErrorCode::FileUnreadable,
                        fmt::format("voxel {} is '{}', which is no {}; correct it or the type in "
                                    "the header",
                                    count_ - 1, printable(word_), typeName));
        }
        std::memcpy(voxels.data() + at, &*value, sizeof(T));
    }
    return {};
}

Result<void> TextVoxels::take(std::span<std::byte> voxels) {
    if (type_.wide != Wide::No) {
        return type_.wide == Wide::Signed ? takeNumbers<std::int64_t>("int64", voxels)
                                          : takeNumbers<std::uint64_t>("uint64", voxels);
    }
    const char* typeName = name(type_.type);
    switch (type_.type) {
    case VoxelType::U8:
        return takeNumbers<std::uint8_t>(typeName, voxels);
    case VoxelType::I8:
        return takeNumbers<std::int8_t>(typeName, voxels);
    case VoxelType::U16:
        return takeNumbers<std::uint16_t>(typeName, voxels);
    case VoxelType::I16:
        return takeNumbers<std::int16_t>(typeName, voxels);
    case VoxelType::U32:
        return takeNumbers<std::uint32_t>(typeName, voxels);
    case VoxelType::I32:
        return takeNumbers<std::int32_t>(typeName, voxels);
    case VoxelType::F32:
        return takeNumbers<float>(typeName, voxels);
    case VoxelType::F64:
        return takeNumbers<double>(typeName, voxels);
    }
    return {};
}

bool readHex(std::istream& stream, std::int64_t skip, std::span<std::byte> bytes) {
    std::streambuf& buffer = *stream.rdbuf();
    const auto digits = 2 * (skip + static_cast<std::int64_t>(bytes.size()));
    for (std::int64_t i = 0; i < digits; ++i) {
        int c = buffer.sbumpc();
        while (isBetween(c)) {
            c = buffer.sbumpc();
        }
        const int digit = hexDigit(c);
        if (digit < 0) {
            return false;
        }
        if (i >= 2 * skip) {
            std::byte& byte = bytes[static_cast<std::size_t>(i / 2 - skip)];
            byte = static_cast<std::byte>(i % 2 == 0 ? digit << 4
                                                     : std::to_integer<int>(byte) | digit);
        }
    }
    return true;
}

} // namespace slabcast

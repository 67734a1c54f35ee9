#include "platform/io/base/parse_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace slabcast {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

std::string_view withoutPlus(std::string_view text) {
    return text.starts_with('+') ? text.substr(1) : text;
}

/// The digits at the start of `text`, without leading zeros.
std::string_view leadingNumber(std::string_view text, std::size_t& length) {
    length = std::find_if_not(text.begin(), text.end(), isDigit) - text.begin();
    const std::string_view digits = text.substr(0, length);
    const std::size_t first = digits.find_first_not_of('0');
    return first == std::string_view::npos ? std::string_view() : digits.substr(first);
}

} // namespace

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) {
        return {};
    }
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return lower;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end = text.find(separator); end != std::string_view::npos;
         end = text.find(separator)) {
        parts.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    parts.push_back(text);
    return parts;
}

std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> found;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
        found.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return found;
}

std::string oneLine(std::string_view text) {
    std::string line;
    for (const std::string_view word : words(text)) {
        line += line.empty() ? "" : " ";
        line += word;
    }
    return line;
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
    const std::string_view digits = withoutPlus(trimmed(text));
    std::int64_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (stop != end || error == std::errc::invalid_argument) {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range) {
        using Limits = std::numeric_limits<std::int64_t>;
        return digits.starts_with('-') ? Limits::min() : Limits::max();
    }
    return value;
}

std::optional<double> parseReal(std::string_view text) {
    const std::string_view digits = withoutPlus(trimmed(text));
    double value = 0.0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (stop != end || error != std::errc()) {
        return std::nullopt;
    }
    return value;
}

std::optional<VoxelType> parseVoxelType(std::string_view text) {
    constexpr std::array kTypes = {VoxelType::U8,  VoxelType::I8,  VoxelType::U16, VoxelType::I16,
                                   VoxelType::U32, VoxelType::I32, VoxelType::F32, VoxelType::F64};
    const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                    [&](VoxelType type) { return name(type) == text; });
    return found == kTypes.end() ? std::nullopt : std::optional(*found);
}

bool naturallyBefore(std::string_view a, std::string_view b) {
    const std::string_view wholeA = a;
    const std::string_view wholeB = b;
    while (!a.empty() && !b.empty()) {
        std::size_t lengthA = 1;
        std::size_t lengthB = 1;
        if (isDigit(a.front()) && isDigit(b.front())) {
            const std::string_view numberA = leadingNumber(a, lengthA);
            const std::string_view numberB = leadingNumber(b, lengthB);
            if (numberA != numberB) {
                return numberA.size() != numberB.size() ? numberA.size() < numberB.size()
                                                        : numberA < numberB;
            }
        } else if (a.front() != b.front()) {
            return a.front() < b.front();
        }
        a.remove_prefix(lengthA);
        b.remove_prefix(lengthB);
    }
    return a.empty() && b.empty() ? wholeA < wholeB : a.empty();
}

} // namespace slabcast

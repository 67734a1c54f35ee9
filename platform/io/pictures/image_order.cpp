#include "platform/io/pictures/image_order.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// A text and the digits behind it; the last one may have none.
struct Part {
    std::string text; // small letters
    std::string digits;
    char sign = '\0'; // where the text ended in one that counts
};

std::vector<Part> partsOf(const std::string& name) {
    std::vector<Part> parts(1);
    for (const char c : lowerCase(name)) {
        if (isDigit(c)) {
            parts.back().digits += c;
            continue;
        }
        if (!parts.back().digits.empty()) {
            parts.emplace_back();
        }
        parts.back().text += c;
    }
    return parts;
}

struct Name {
    std::filesystem::path path;
    std::vector<Part> parts;
};

bool endsInSign(const Part& part) {
    return !part.digits.empty() && (part.text.ends_with('+') || part.text.ends_with('-'));
}

/// What stands before the digits at `place`, without a sign.
std::string before(const Name& name, std::size_t place) {
    const Part& part = name.parts[place];
    return endsInSign(part) ? part.text.substr(0, part.text.size() - 1) : part.text;
}

/// Whether '+' and '-' before the number at `place` are signs rather than hyphens.
bool isSigned(const std::vector<Name>& names, std::size_t place) {
    std::set<std::string> withMinus;
    std::set<std::string> without;
    for (const Name& name : names) {
        if (place >= name.parts.size() || name.parts[place].digits.empty()) {
            continue;
        }
        if (name.parts[place].text.ends_with('+')) {
            return true;
        }
        (endsInSign(name.parts[place]) ? withMinus : without).insert(before(name, place));
    }
    return std::any_of(without.begin(), without.end(),
                       [&](const std::string& text) { return withMinus.contains(text); });
}

std::vector<Name> namesOf(const std::vector<std::filesystem::path>& files) {
    std::vector<Name> names;
    std::size_t places = 0;
    for (const std::filesystem::path& file : files) {
        names.push_back({file, partsOf(file.filename().string())});
        places = std::max(places, names.back().parts.size());
    }
    for (std::size_t place = 0; place < places; ++place) {
        if (!isSigned(names, place)) {
            continue;
        }
        for (Name& name : names) {
            if (place < name.parts.size() && endsInSign(name.parts[place])) {
                name.parts[place].sign = name.parts[place].text.back();
                name.parts[place].text.pop_back();
            }
        }
    }
    return names;
}

/// Less than, equal to or greater than 0, as `a` comes before or behind `b`.
int compareNumbers(const Part& a, const Part& b) {
    const auto significant = [](const std::string& digits) {
        return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
    };
    const std::string left = significant(a.digits);
    const std::string right = significant(b.digits);
    const bool leftIsBelow = a.sign == '-' && !left.empty();
    const bool rightIsBelow = b.sign == '-' && !right.empty();
    if (leftIsBelow != rightIsBelow) {
        return leftIsBelow ? -1 : 1;
    }
    const int order =
        left.size() != right.size() ? (left.size() < right.size() ? -1 : 1) : left.compare(right);
    return leftIsBelow ? -order : order;
}

/// A text with digits behind it stands where its first digit would put it.
std::string sortedText(const Part& part) {
    return part.digits.empty() ? part.text : part.text + '0';
}

bool comesBefore(const Name& a, const Name& b) {
    for (std::size_t i = 0; i < std::min(a.parts.size(), b.parts.size()); ++i) {
        const int texts = sortedText(a.parts[i]).compare(sortedText(b.parts[i]));
        if (texts != 0) {
            return texts < 0;
        }
        if (const int order = compareNumbers(a.parts[i], b.parts[i]); order != 0) {
            return order < 0;
        }
    }
    return a.parts.size() != b.parts.size()
               ? a.parts.size() < b.parts.size()
               : a.path.filename().string() < b.path.filename().string();
}

/// The name with '#' for each number; 'tif' and 'tiff', 'jpg' and 'jpeg' are the same.
std::string patternOf(const Name& name) {
    std::string pattern;
    for (const Part& part : name.parts) {
        // A fraction is no number of its own: 1.png, 1.5.png, 2.png
        const bool isFraction = part.text == "." && !part.digits.empty() && pattern.ends_with('#');
        pattern += isFraction ? "" : part.text + (part.digits.empty() ? "" : "#");
    }
    for (const auto& [from, to] : {std::pair(".tiff", ".tif"), std::pair(".jpeg", ".jpg")}) {
        if (pattern.ends_with(from)) {
            pattern.replace(pattern.size() - std::string_view(from).size(), std::string::npos, to);
        }
    }
    return pattern;
}

} // namespace

void sortByNames(std::vector<std::filesystem::path>& files) {
    std::vector<Name> names = namesOf(files);
    std::sort(names.begin(), names.end(), comesBefore);
    std::transform(names.begin(), names.end(), files.begin(),
                   [](const Name& name) { return name.path; });
}

Result<void> checkOneSeries(const std::filesystem::path& folder,
                            const std::vector<std::filesystem::path>& files) {
    std::map<std::string, std::vector<std::filesystem::path>> kinds;
    for (const Name& name : namesOf(files)) {
        kinds[patternOf(name)].push_back(name.path);
    }
    const auto fewer = [](const auto& a, const auto& b) {
        return a.second.size() < b.second.size();
    };
    const auto most = std::max_element(kinds.begin(), kinds.end(), fewer);
    const auto least = std::min_element(kinds.begin(), kinds.end(), fewer);
    const std::size_t others = files.size() - most->second.size();
    if (others == 0) {
        return {};
    }
    // Three of a kind, and at least two thirds: the others do not belong to it.
    if (most->second.size() >= 3 && others * 3 <= files.size() && least->second.size() == 1) {
        return fail(ErrorCode::AmbiguousSeries,
                    fmt::format("{}: is named unlike the other images of its folder ({}, {} of "
                                "them); take away what does not belong to the stack",
                                least->second.front().string(), most->first, most->second.size()));
    }
    if (kinds.size() <= 4 && least->second.size() >= 3) {
        return fail(
            ErrorCode::AmbiguousSeries,
            fmt::format("{}: holds several series of images, {} ({} files) and {} ({} "
                        "files); move all but one to folders of their own",
                        folder.string(), most->first, most->second.size(),
                        least == most ? std::next(least)->first : least->first,
                        least == most ? std::next(least)->second.size() : least->second.size()));
    }
    return {};
}

} // namespace slabcast

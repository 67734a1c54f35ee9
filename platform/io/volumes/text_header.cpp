#include "platform/io/volumes/text_header.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include "core/base/printable.h"
#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;

constexpr std::size_t kMaxStartBytes = 1 << 22; // a binary file may hold no line end at all
constexpr std::size_t kMaxAxes = 16;
constexpr std::int64_t kMaxDataFiles = 100000;
constexpr std::int64_t kFarBeyondAnyFile = std::int64_t{1} << 60;

/// Takes the next line off the text, without its end.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
}

/// A field that is there twice must say the same.
Result<void> addField(const Path& path, TextHeader& header, std::string_view name,
                      std::string_view value) {
    const auto [there, isNew] =
        header.fields.emplace(lowerCase(trimmed(name)), std::string(trimmed(value)));
    if (!isNew && there->second != trimmed(value)) {
        return unreadable(path, fmt::format("the field '{}' is there twice, as '{}' and as '{}'",
                                            printable(there->first), printable(there->second),
                                            printable(trimmed(value))));
    }
    return {};
}

bool isList(std::string_view value) {
    return value == "LIST" || value.starts_with("LIST ") || value.starts_with("LIST\t");
}

void takeList(TextHeader& header, std::string_view rest) {
    while (!rest.empty()) {
        const std::string_view line = trimmed(takeLine(rest));
        if (!line.empty()) {
            header.listed.emplace_back(line);
        }
    }
    header.ended = true;
}

/// Product of the sizes from `first` on; 0 where one is not positive or the product is beyond any
/// number of files.
std::int64_t product(const std::vector<std::int64_t>& sizes, std::size_t first) {
    std::int64_t count = 1;
    for (std::size_t axis = first; axis < sizes.size() && count > 0; ++axis) {
        const bool fits = sizes[axis] > 0 && sizes[axis] <= kFarBeyondAnyFile / count;
        count = fits ? count * sizes[axis] : 0;
    }
    return count;
}

/// As many files as the axes behind the first `axesInEach` ask for; where those are all, any
/// number that divides the last.
Result<void> checkFileCount(const Path& path, std::int64_t count, std::int64_t axesInEach,
                            const std::vector<std::int64_t>& sizes) {
    const auto axes = static_cast<std::int64_t>(sizes.size());
    if (axesInEach < 1 || axesInEach > axes) {
        return unreadable(path, fmt::format("its files of voxels have {} dimensions, the header {}",
                                            axesInEach, axes));
    }
    const bool slabs = axesInEach == axes;
    const std::int64_t wanted = product(sizes, static_cast<std::size_t>(axesInEach) - slabs);
    const bool right =
        slabs ? count > 0 && wanted % std::max<std::int64_t>(count, 1) == 0 : count == wanted;
    if (!right && wanted > 0) {
        return unreadable(
            path, fmt::format("lists {} files of voxels, and its sizes ask for {}", count, wanted));
    }
    if (count < 1 || count > kMaxDataFiles) {
        return unreadable(path, fmt::format("lists {} files of voxels, and read are 1 to {}", count,
                                            kMaxDataFiles));
    }
    return {};
}

/// A file name with one place for a number: "%d", "%03d".
struct NumberedName {
    std::string before;
    int width = 0;
    bool zeros = false;
    std::string after;

    std::string at(std::int64_t number) const {
        return zeros ? fmt::format("{}{:0{}}{}", before, number, width, after)
                     : fmt::format("{}{:{}}{}", before, number, width, after);
    }
};

std::optional<NumberedName> parseNumberedName(std::string_view text) {
    NumberedName name;
    const std::size_t percent = text.find('%');
    if (percent == std::string_view::npos) {
        return std::nullopt;
    }
    name.before = text.substr(0, percent);
    text.remove_prefix(percent + 1);
    name.zeros = text.starts_with('0');
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    name.width = static_cast<int>(
        std::min<std::int64_t>(parseInteger(text.substr(0, digits)).value_or(0), 64));
    text.remove_prefix(digits);
    if (text.empty() || std::string_view("diu").find(text.front()) == std::string_view::npos) {
        return std::nullopt;
    }
    name.after = text.substr(1);
    return name.after.find('%') == std::string::npos ? std::optional(name) : std::nullopt;
}

/// "NAME MIN MAX STEP [AXES]"
Result<std::vector<Path>> numberedFiles(const Path& path, std::string_view written,
                                        const std::vector<std::int64_t>& sizes) {
    const std::vector<std::string_view> parts = words(written);
    const std::optional<NumberedName> name = parseNumberedName(parts.front());
    const Result<std::vector<std::int64_t>> numbers =
        parseIntegers(path, printable(written),
                      written.substr(written.find(parts.front()) + parts.front().size()));
    if (!name || !numbers || numbers->size() < 3 || numbers->size() > 4 || numbers->at(2) == 0) {
        return unreadable(path, fmt::format("'{}' is no pattern of file names as 's%03d.raw 1 9 1'",
                                            printable(written)));
    }
    const std::int64_t first = std::clamp(numbers->at(0), -kFarBeyondAnyFile, kFarBeyondAnyFile);
    const std::int64_t last = std::clamp(numbers->at(1), -kFarBeyondAnyFile, kFarBeyondAnyFile);
    const std::int64_t step = std::clamp(numbers->at(2), -kFarBeyondAnyFile, kFarBeyondAnyFile);
    const std::int64_t count = (last - first) / step + 1;
    const std::int64_t axes =
        numbers->size() == 4 ? numbers->at(3) : static_cast<std::int64_t>(sizes.size()) - 1;
    if (const Result<void> sound = checkFileCount(path, count, axes, sizes); !sound) {
        return tl::unexpected(sound.error());
    }
    std::vector<Path> files;
    for (std::int64_t i = 0; i < count; ++i) {
        files.push_back(path.parent_path() / name->at(first + i * step));
    }
    return files;
}

Result<std::vector<Path>> listedFiles(const Path& path, const TextHeader& text,
                                      std::string_view written,
                                      const std::vector<std::int64_t>& sizes) {
    std::string_view axesText = trimmed(written.substr(4)); // behind "LIST"; MetaImage has "2D"
    if (axesText.ends_with('D') || axesText.ends_with('d')) {
        axesText.remove_suffix(1);
    }
    const std::int64_t axes = axesText.empty() ? static_cast<std::int64_t>(sizes.size()) - 1
                                               : parseInteger(axesText).value_or(0);
    const Result<void> sound =
        checkFileCount(path, static_cast<std::int64_t>(text.listed.size()), axes, sizes);
    if (!sound) {
        return tl::unexpected(sound.error());
    }
    std::vector<Path> files;
    for (const std::string& name : text.listed) {
        files.push_back(path.parent_path() / name);
    }
    return files;
}

} // namespace

std::optional<std::string_view> TextHeader::find(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
        const auto found = fields.find(lowerCase(name));
        if (found != fields.end()) {
            return found->second;
        }
    }
    return std::nullopt;
}

std::string_view TextHeader::findOr(std::initializer_list<const char*> names,
                                    std::string_view otherwise) const {
    return find(names).value_or(otherwise);
}

Result<TextHeader> parseNrrdText(const Path& path, std::string_view start) {
    constexpr std::string_view kMagic = "NRRD000";
    if (!start.starts_with(kMagic)) {
        return unreadable(path, fmt::format("does not begin with {}", kMagic));
    }
    TextHeader header;
    std::string_view rest = start;
    takeLine(rest);
    while (!rest.empty() && !header.ended) {
        const std::string_view line = trimmed(takeLine(rest));
        header.bytes = static_cast<std::int64_t>(start.size() - rest.size());
        header.ended = line.empty();
        if (line.empty() || line.starts_with('#')) {
            continue;
        }
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos || colon == 0) {
            return unreadable(path, fmt::format("'{}' in its header is neither a field nor a "
                                                "comment",
                                                printable(line)));
        }
        if (line.substr(colon).starts_with(":=")) {
            header.keys.emplace(lowerCase(trimmed(line.substr(0, colon))),
                                trimmed(line.substr(colon + 2)));
            continue;
        }
        const std::string_view value = trimmed(line.substr(colon + 1));
        const Result<void> added = addField(path, header, line.substr(0, colon), value);
        if (!added) {
            return tl::unexpected(added.error());
        }
        if (isList(value) && lowerCase(line).starts_with("data")) {
            takeList(header, rest);
        }
    }
    return header;
}

Result<TextHeader> parseMetaText(const Path& path, std::string_view start) {
    TextHeader header;
    std::string_view rest = start;
    if (rest.empty()) {
        return unreadable(path, "does not begin with a header");
    }
    while (!rest.empty() && !header.ended) {
        const std::string_view line = trimmed(takeLine(rest));
        header.bytes = static_cast<std::int64_t>(start.size() - rest.size());
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) {
            continue;
        }
        const std::string_view value = trimmed(line.substr(equals + 1));
        const Result<void> added = addField(path, header, line.substr(0, equals), value);
        if (!added) {
            return tl::unexpected(added.error());
        }
        header.ended = header.fields.contains("elementdatafile");
        if (header.ended && isList(value)) {
            takeList(header, rest);
        }
    }
    return header;
}

std::string textStart(const Path& path) {
    std::string start(kMaxStartBytes, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    return start;
}

tl::unexpected<Error> unreadable(const Path& path, std::string_view why) {
    return fail(
        ErrorCode::FileUnreadable,
        fmt::format("{}: {}; check that the file is whole and of the format that its name says",
                    path.string(), why));
}

std::string printable(std::string_view text) {
    constexpr std::size_t kMost = 60;
    const std::string shown = withoutControls(text.substr(0, kMost));
    return text.size() > kMost ? shown + "..." : shown;
}

Result<std::vector<std::int64_t>> parseIntegers(const Path& path, std::string_view name,
                                                std::string_view text) {
    std::vector<std::int64_t> values;
    for (const std::string_view word : words(text)) {
        const std::optional<std::int64_t> value = parseInteger(word);
        if (!value) {
            return unreadable(
                path, fmt::format("'{}' in field '{}' is no integer", printable(word), name));
        }
        values.push_back(*value);
    }
    return values;
}

Result<std::vector<std::int64_t>> parseSizes(const Path& path, const TextHeader& text,
                                             const char* name, const char* rank) {
    Result<std::vector<std::int64_t>> sizes = parseIntegers(path, name, text.findOr({name}, ""));
    if (!sizes) {
        return sizes;
    }
    if (parseInteger(text.findOr({rank}, "")) != static_cast<std::int64_t>(sizes->size())) {
        return unreadable(path,
                          fmt::format("'{}' and the number of values in '{}' differ", rank, name));
    }
    if (sizes->size() > kMaxAxes) {
        return unreadable(
            path, fmt::format("has {} dimensions, and {} are the most", sizes->size(), kMaxAxes));
    }
    return sizes;
}

Result<std::int64_t> parseSkip(const Path& path, const TextHeader& text,
                               std::initializer_list<const char*> names, std::int64_t least) {
    const std::string_view written = text.findOr(names, "0");
    const std::optional<std::int64_t> skip = parseInteger(written);
    if (!skip || *skip < least) {
        return unreadable(path, fmt::format("'{}' in field '{}' is no number of {} or more",
                                            printable(written), *names.begin(), least));
    }
    return std::min(*skip, kFarBeyondAnyFile);
}

std::vector<double> realsOrNan(std::string_view text) {
    std::vector<double> values;
    for (const std::string_view word : words(text)) {
        values.push_back(parseReal(word).value_or(std::nan("")));
    }
    return values;
}

Modality parseModality(std::string_view text) {
    static const std::map<std::string, Modality> kNames = {{"ct", Modality::Ct},
                                                           {"met_mod_ct", Modality::Ct},
                                                           {"mr", Modality::Mr},
                                                           {"mri", Modality::Mr},
                                                           {"met_mod_mr", Modality::Mr}};
    const auto found = kNames.find(lowerCase(text));
    return found == kNames.end() ? Modality::Unknown : found->second;
}

Result<std::vector<Path>> dataFiles(const Path& path, const TextHeader& text,
                                    std::string_view written,
                                    const std::vector<std::int64_t>& sizes) {
    if (isList(written)) {
        return listedFiles(path, text, written, sizes);
    }
    const Path single = path.parent_path() / written;
    std::error_code error;
    const bool numbered = written.find('%') != std::string_view::npos &&
                          words(written).size() > 1 && !std::filesystem::exists(single, error);
    return numbered ? numberedFiles(path, written, sizes) : std::vector<Path>{single};
}

} // namespace slabcast

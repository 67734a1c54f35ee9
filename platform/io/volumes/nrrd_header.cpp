#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/volumes/file_header.h"
#include "platform/io/volumes/length_unit.h"
#include "platform/io/volumes/text_header.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;
using Sizes = std::vector<std::int64_t>;

struct NamedType {
    std::string_view name;
    StoredType type;
};

constexpr StoredType kI64 = {VoxelType::F64, Wide::Signed};
constexpr StoredType kU64 = {VoxelType::F64, Wide::Unsigned};

constexpr std::array<NamedType, 42> kTypes = {{{"signed char", {VoxelType::I8}},
                                               {"char", {VoxelType::I8}},
                                               {"int8", {VoxelType::I8}},
                                               {"int8_t", {VoxelType::I8}},
                                               {"uchar", {VoxelType::U8}},
                                               {"unsigned char", {VoxelType::U8}},
                                               {"uint8", {VoxelType::U8}},
                                               {"uint8_t", {VoxelType::U8}},
                                               {"short", {VoxelType::I16}},
                                               {"short int", {VoxelType::I16}},
                                               {"signed short", {VoxelType::I16}},
                                               {"signed short int", {VoxelType::I16}},
                                               {"int16", {VoxelType::I16}},
                                               {"int16_t", {VoxelType::I16}},
                                               {"ushort", {VoxelType::U16}},
                                               {"unsigned short", {VoxelType::U16}},
                                               {"unsigned short int", {VoxelType::U16}},
                                               {"uint16", {VoxelType::U16}},
                                               {"uint16_t", {VoxelType::U16}},
                                               {"int", {VoxelType::I32}},
                                               {"signed int", {VoxelType::I32}},
                                               {"int32", {VoxelType::I32}},
                                               {"int32_t", {VoxelType::I32}},
                                               {"uint", {VoxelType::U32}},
                                               {"unsigned int", {VoxelType::U32}},
                                               {"uint32", {VoxelType::U32}},
                                               {"uint32_t", {VoxelType::U32}},
                                               {"float", {VoxelType::F32}},
                                               {"double", {VoxelType::F64}},
                                               {"longlong", kI64},
                                               {"long long", kI64},
                                               {"long long int", kI64},
                                               {"signed long long", kI64},
                                               {"signed long long int", kI64},
                                               {"int64", kI64},
                                               {"int64_t", kI64},
                                               {"ulonglong", kU64},
                                               {"unsigned long long", kU64},
                                               {"unsigned long long int", kU64},
                                               {"uint64", kU64},
                                               {"uint64_t", kU64},
                                               {"unsigned long long integer", kU64}}};

std::optional<StoredType> typeOf(std::string_view written) {
    const std::string name = lowerCase(written);
    const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                    [&](const NamedType& entry) { return entry.name == name; });
    return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

DataEncoding encodingOf(std::string_view written) {
    static const std::map<std::string, DataEncoding> kNames = {
        {"raw", DataEncoding::Raw},    {"gzip", DataEncoding::Deflate},
        {"gz", DataEncoding::Deflate}, {"ascii", DataEncoding::Text},
        {"text", DataEncoding::Text},  {"txt", DataEncoding::Text},
        {"hex", DataEncoding::Hex}};
    const auto found = kNames.find(lowerCase(written));
    return found == kNames.end() ? DataEncoding::Other : found->second;
}

/// A misspelt field must not pass for one that is left out.
Result<void> checkNames(const Path& path, const TextHeader& text) {
    static const std::set<std::string_view> kKnown = {"content",
                                                      "number",
                                                      "type",
                                                      "dimension",
                                                      "space",
                                                      "space dimension",
                                                      "space units",
                                                      "space origin",
                                                      "space directions",
                                                      "measurement frame",
                                                      "sizes",
                                                      "spacings",
                                                      "thicknesses",
                                                      "axis mins",
                                                      "axismins",
                                                      "axis maxs",
                                                      "axismaxs",
                                                      "centers",
                                                      "centerings",
                                                      "kinds",
                                                      "labels",
                                                      "units",
                                                      "min",
                                                      "max",
                                                      "old min",
                                                      "oldmin",
                                                      "old max",
                                                      "oldmax",
                                                      "block size",
                                                      "blocksize",
                                                      "endian",
                                                      "encoding",
                                                      "line skip",
                                                      "lineskip",
                                                      "byte skip",
                                                      "byteskip",
                                                      "data file",
                                                      "datafile",
                                                      "sample units",
                                                      "sampleunits"};
    for (const auto& [name, value] : text.fields) {
        if (!kKnown.contains(name)) {
            return unreadable(path, fmt::format("'{}' is no field of NRRD", printable(name)));
        }
    }
    return {};
}

/// Of "(1,0,0) none (0,0,2)"; `none` is nothing, and what is no number is NaN.
using Vector = std::optional<std::vector<double>>;

std::vector<Vector> parseVectors(std::string_view text) {
    std::vector<Vector> vectors;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        const bool isVector = text.front() == '(';
        const std::size_t end = text.find_first_of(isVector ? ")" : " \t");
        Vector vector;
        if (isVector) {
            vector.emplace();
            for (const std::string_view part : split(text.substr(1, end - 1), ',')) {
                vector->push_back(parseReal(part).value_or(std::nan("")));
            }
        }
        vectors.push_back(std::move(vector));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return vectors;
}

glm::dvec3 spaceOf(const std::vector<double>& vector) {
    glm::dvec3 place{0.0};
    for (std::size_t row = 0; row < std::min<std::size_t>(vector.size(), 3); ++row) {
        place[static_cast<int>(row)] = vector[row];
    }
    return place;
}

/// `"mm" "micro meters"`, or plain words.
std::vector<std::string> quotedWords(std::string_view text) {
    std::vector<std::string> found;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        const bool quoted = text.front() == '"';
        text.remove_prefix(quoted ? 1 : 0);
        const std::size_t end = std::min(text.find_first_of(quoted ? "\"" : " \t"), text.size());
        found.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return found;
}

enum class Role : std::uint8_t { Space, Time, Components };

/// One axis of the file, as its fields have it.
struct Axis {
    std::size_t index;
    std::int64_t size;
    Role role;
    bool isList;
};

Role roleOf(std::string_view kind, bool hasDirections, const Vector& direction) {
    static const std::set<std::string_view> kUnsaid = {"", "???", "none", "domain", "space"};
    if (!kUnsaid.contains(kind) && kind != "time") {
        return Role::Components;
    }
    const bool alongTime = direction && direction->size() > 3 && (*direction)[3] != 0.0 &&
                           spaceOf(*direction) == glm::dvec3(0.0);
    return kind == "time" || alongTime || (hasDirections && !direction) ? Role::Time : Role::Space;
}

std::vector<Axis> axesOf(const TextHeader& text, const Sizes& sizes) {
    const std::vector<std::string_view> kinds = words(text.findOr({"kinds"}, ""));
    std::vector<Vector> directions = parseVectors(text.findOr({"space directions"}, ""));
    const bool hasDirections = !directions.empty();
    directions.resize(sizes.size());
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const std::string kind = i < kinds.size() ? lowerCase(kinds[i]) : "";
        axes.push_back({i, sizes[i], roleOf(kind, hasDirections, directions[i]), kind == "list"});
    }
    return axes;
}

std::size_t countOf(const std::vector<Axis>& axes, Role role) {
    return static_cast<std::size_t>(std::count_if(
        axes.begin(), axes.end(), [&](const Axis& axis) { return axis.role == role; }));
}

/// Leaves the axes of space, and behind them those of time that are longer than one.
void sortAxes(FileHeader& header, std::vector<Axis>& axes) {
    const auto drop = [&](auto which) { std::erase_if(axes, which); };
    if (!axes.empty() && axes.back().isList && countOf(axes, Role::Space) == 3) {
        axes.back().role = Role::Time; // one volume behind the other
    }
    for (const Axis& axis : axes) {
        if (axis.role == Role::Components) {
            constexpr std::int64_t kMany = 1 << 30;
            header.components = std::clamp<std::int64_t>(axis.size, 0, kMany) * header.components;
            header.components = std::min(header.components, kMany);
        }
    }
    drop([](const Axis& axis) { return axis.role == Role::Components; });
    for (Axis& axis : axes) { // a film of two dimensions: time is its depth
        if (axis.role == Role::Time && countOf(axes, Role::Space) < 3) {
            axis.role = Role::Space;
        }
    }
    drop([](const Axis& axis) { return axis.role == Role::Time && axis.size == 1; });
    while (axes.size() > 3 && axes.back().size == 1) {
        axes.pop_back();
    }
    while (axes.size() > 3 && axes.front().size == 1) {
        axes.erase(axes.begin());
    }
    if (axes.size() == 4 && countOf(axes, Role::Time) == 0) {
        axes.back().role = Role::Time;
    }
}

Result<void> setAxesOf(const Path& path, FileHeader& header, std::vector<Axis>& axes) {
    sortAxes(header, axes);
    const bool timed = axes.size() == 4 && countOf(axes, Role::Time) == 1;
    if (timed && axes.back().role != Role::Time) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: its axis of time runs faster than one of space, and is read "
                                "only as the slowest; extract one time step",
                                path.string()));
    }
    if (timed) {
        header.times = axes.back().size;
        axes.pop_back();
    }
    for (const Axis& axis : axes) {
        header.sizes.push_back(axis.size);
    }
    return {};
}

/// How the file's space lies in LPS.
struct Space {
    glm::dvec3 signs{1.0};
    std::string note;
};

/// -1 where the word is the opposite of LPS's, 1 where it is LPS's, 0 for any other.
double signOf(std::string_view word, std::string_view same, std::string_view opposite) {
    const bool isSame = word == same || word == same.substr(0, 1);
    const bool isOpposite = word == opposite || word == opposite.substr(0, 1);
    return isSame ? 1.0 : isOpposite ? -1.0 : 0.0;
}

Space parseSpace(const TextHeader& text) {
    const std::string written = lowerCase(text.findOr({"space"}, ""));
    std::string name = written;
    std::vector<std::string_view> parts;
    if (name.ends_with("-time")) {
        name.resize(name.size() - 5);
    }
    if (name.find('-') != std::string::npos) {
        parts = split(name, '-');
    } else if (name.size() == 3 || (name.size() == 4 && name.ends_with('t'))) {
        for (std::size_t i = 0; i < 3; ++i) {
            parts.push_back(std::string_view(name).substr(i, 1));
        }
    }
    Space space;
    if (parts.size() == 3) {
        const glm::dvec3 signs(signOf(parts[0], "left", "right"),
                               signOf(parts[1], "posterior", "anterior"),
                               signOf(parts[2], "superior", "inferior"));
        if (signs.x * signs.y * signs.z != 0.0) {
            space.signs = signs;
            return space;
        }
    }
    if (!written.empty() || text.find({"space dimension"})) {
        space.note =
            fmt::format("its space {} says nothing of a patient's sides; taken for "
                        "left-posterior-superior",
                        written.empty() ? "of no name" : fmt::format("'{}'", printable(written)));
    }
    return space;
}

/// Millimetres per unit of a field that holds one for each; in words where one is unknown.
std::vector<double> unitsOf(FileHeader& header, const TextHeader& text, const char* field,
                            std::size_t count) {
    const std::vector<std::string> names = quotedWords(text.findOr({field}, ""));
    std::vector<double> factors(count, 1.0);
    for (std::size_t i = 0; i < std::min(count, names.size()); ++i) {
        const std::optional<double> factor = millimetresPer(names[i]);
        factors[i] = factor.value_or(1.0);
        if (!factor && !isNoUnit(names[i])) {
            header.notes.push_back(fmt::format("'{}' in field '{}' is no unit of length that is "
                                               "known; taken as mm",
                                               printable(names[i]), field));
        }
    }
    return factors;
}

/// A field that holds one number for each axis, of any role.
Result<std::vector<double>> perAxis(const Path& path, const TextHeader& text,
                                    std::initializer_list<const char*> names, std::size_t rank) {
    std::vector<double> values = realsOrNan(text.findOr(names, ""));
    if (!values.empty() && values.size() != rank) {
        return unreadable(path, fmt::format("the field '{}' holds {} numbers for {} axes",
                                            *names.begin(), values.size(), rank));
    }
    return values;
}

/// Of `space origin`, in LPS and mm; 0, 0, 0 where it is not there.
glm::dvec3 spaceOrigin(FileHeader& header, const TextHeader& text, const Space& space,
                       const glm::dvec3& millimetres) {
    const std::vector<Vector> origins = parseVectors(text.findOr({"space origin"}, ""));
    const glm::dvec3 origin =
        !origins.empty() && origins[0] ? spaceOf(*origins[0]) : glm::dvec3(0.0);
    if (!std::isfinite(origin.x + origin.y + origin.z)) {
        header.notes.emplace_back("its 'space origin' holds no finite numbers; taken as 0, 0, 0");
        return glm::dvec3(0.0);
    }
    return space.signs * millimetres * origin;
}

/// By `space directions` and `space origin`.
Result<Placement> placeInSpace(const Path& path, FileHeader& header, const TextHeader& text,
                               const std::vector<Axis>& axes, std::size_t rank) {
    std::vector<Vector> directions = parseVectors(text.findOr({"space directions"}, ""));
    if (directions.size() > rank) {
        return unreadable(path, fmt::format("the field 'space directions' holds {} vectors for {} "
                                            "axes",
                                            directions.size(), rank));
    }
    directions.resize(rank);
    const Space space = parseSpace(text);
    if (!space.note.empty()) {
        header.notes.push_back(space.note);
    }
    const std::vector<double> units = unitsOf(header, text, "space units", 3);
    const glm::dvec3 millimetres(units[0], units[1], units[2]);
    glm::dmat3 steps(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        const Vector& direction = directions[axes[static_cast<std::size_t>(axis)].index];
        const glm::dvec3 step = direction ? spaceOf(*direction) : glm::dvec3(std::nan(""));
        header.spacings.push_back(std::sqrt(glm::dot(step, step)));
        steps[axis] = space.signs * millimetres * step;
    }
    return placementOf(steps, spaceOrigin(header, text, space, millimetres));
}

/// Axes that have a space and no directions in it run along its own.
Placement placeAlongSpace(FileHeader& header, const TextHeader& text, const glm::dmat3& steps,
                          const glm::dvec3& origin) {
    const Space space = parseSpace(text);
    const std::vector<double> units = unitsOf(header, text, "space units", 3);
    if (!space.note.empty()) {
        header.notes.push_back(space.note);
    } else if (space.signs != glm::dvec3(1.0)) {
        header.notes.emplace_back("has no 'space directions'; its axes are taken along those of "
                                  "its space");
    }
    glm::dmat3 turned;
    for (int axis = 0; axis < 3; ++axis) {
        turned[axis] = space.signs * steps[axis];
    }
    const glm::dvec3 millimetres(units[0], units[1], units[2]);
    return placementOf(turned, text.find({"space origin"})
                                   ? spaceOrigin(header, text, space, millimetres)
                                   : space.signs * origin);
}

/// By `spacings`, `axis mins`, `axis maxs` and `centers`: samples lie at the nodes of a grid or in
/// the middle of its cells.
Result<Placement> placeOnAxes(const Path& path, FileHeader& header, const TextHeader& text,
                              const std::vector<Axis>& axes, std::size_t rank) {
    Result<std::vector<double>> spacings = perAxis(path, text, {"spacings"}, rank);
    Result<std::vector<double>> mins = perAxis(path, text, {"axis mins", "axismins"}, rank);
    Result<std::vector<double>> maxs = perAxis(path, text, {"axis maxs", "axismaxs"}, rank);
    for (const auto* values : {&spacings, &mins, &maxs}) {
        if (!*values) {
            return tl::unexpected(values->error());
        }
    }
    const std::vector<std::string_view> centers = words(text.findOr({"centers", "centerings"}, ""));
    const std::vector<double> units = unitsOf(header, text, "units", rank);
    glm::dmat3 steps(1.0);
    glm::dvec3 origin{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const auto [index, size, role, isList] = axes[static_cast<std::size_t>(axis)];
        const bool nodes = index < centers.size() && lowerCase(centers[index]) == "node";
        const auto steps1 = static_cast<double>(nodes ? std::max<std::int64_t>(size - 1, 1) : size);
        const bool hasRange = !mins->empty() && !maxs->empty() && std::isfinite((*mins)[index]) &&
                              std::isfinite((*maxs)[index]) && (*mins)[index] != (*maxs)[index];
        double spacing = 1.0;
        if (!spacings->empty()) {
            spacing = (*spacings)[index];
        } else if (hasRange) {
            spacing = ((*maxs)[index] - (*mins)[index]) / steps1;
        }
        if (!spacings->empty() || hasRange) {
            header.spacings.push_back(spacing);
        }
        const bool hasMin = !mins->empty() && std::isfinite((*mins)[index]);
        const double first = hasMin ? (*mins)[index] + (nodes ? 0.0 : spacing / 2.0) : 0.0;
        steps[axis][axis] = units[index] * spacing;
        origin[axis] = units[index] * first;
    }
    return text.find({"space"}) ? placeAlongSpace(header, text, steps, origin)
                                : placementOf(steps, origin);
}

Result<void> setSource(const Path& path, FileHeader& header, const TextHeader& text,
                       const Sizes& sizes) {
    header.encodingName = printable(text.findOr({"encoding"}, ""));
    header.source.encoding = encodingOf(text.findOr({"encoding"}, ""));
    const std::string endian = lowerCase(text.findOr({"endian"}, ""));
    if (endian == "little" || endian == "big") {
        header.bigEndian = endian == "big";
    }
    const std::string_view written = text.findOr({"data file", "datafile"}, "");
    if (written.empty()) {
        header.source.files = {path};
        header.source.headerBytes = text.bytes;
    } else {
        Result<std::vector<Path>> files = dataFiles(path, text, written, sizes);
        if (!files) {
            return tl::unexpected(files.error());
        }
        header.source.files = std::move(*files);
    }
    constexpr std::int64_t kLeastByteSkip = -(std::int64_t{1} << 60);
    const Result<std::int64_t> lines = parseSkip(path, text, {"line skip", "lineskip"}, 0);
    const Result<std::int64_t> bytes =
        parseSkip(path, text, {"byte skip", "byteskip"}, kLeastByteSkip);
    if (!lines || !bytes) {
        return tl::unexpected(lines ? bytes.error() : lines.error());
    }
    header.source.lineSkip = *lines;
    header.source.byteSkip = *bytes;
    return {};
}

std::string keyOr(const TextHeader& text, const char* name) {
    const auto found = text.keys.find(name);
    return found == text.keys.end() ? "" : found->second;
}

} // namespace

Result<FileHeader> parseNrrdHeader(std::string_view start, const Path& path) {
    const Result<TextHeader> text = parseNrrdText(path, start);
    if (!text) {
        return tl::unexpected(text.error());
    }
    const Result<Sizes> sizes = parseSizes(path, *text, "sizes", "dimension");
    if (!sizes) {
        return tl::unexpected(sizes.error());
    }
    FileHeader header;
    header.typeName = printable(text->findOr({"type"}, "none"));
    header.type = typeOf(text->findOr({"type"}, ""));
    header.unit = keyOr(*text, "unit");
    header.modality = parseModality(keyOr(*text, "modality"));
    std::vector<Axis> axes = axesOf(*text, *sizes);
    const Result<void> sound =
        checkNames(path, *text)
            .and_then([&]() { return setAxesOf(path, header, axes); })
            .and_then([&]() { return setSource(path, header, *text, *sizes); });
    if (!sound) {
        return tl::unexpected(sound.error());
    }
    if (axes.size() == 3) {
        header.placement = text->find({"space directions"})
                               ? placeInSpace(path, header, *text, axes, sizes->size())
                               : placeOnAxes(path, header, *text, axes, sizes->size());
    }
    return header;
}

Result<FileHeader> readNrrdHeader(const Path& path) {
    return parseNrrdHeader(textStart(path), path);
}

} // namespace slabcast

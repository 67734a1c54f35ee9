#include "platform/io/volumes/nrrd_header_place.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/volumes/length_unit.h"

namespace slabcast::nrrd {

namespace {

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
Result<std::vector<double>> perAxis(const std::filesystem::path& path, const TextHeader& text,
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
Result<Placement> placeInSpace(const std::filesystem::path& path, FileHeader& header,
                               const TextHeader& text, const std::vector<Axis>& axes,
                               std::size_t rank) {
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
Result<Placement> placeOnAxes(const std::filesystem::path& path, FileHeader& header,
                              const TextHeader& text, const std::vector<Axis>& axes,
                              std::size_t rank) {
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

} // namespace

Result<Placement> placementOfAxes(const std::filesystem::path& path, FileHeader& header,
                                  const TextHeader& text, const std::vector<Axis>& axes,
                                  std::size_t rank) {
    return text.find({"space directions"}) ? placeInSpace(path, header, text, axes, rank)
                                           : placeOnAxes(path, header, text, axes, rank);
}

} // namespace slabcast::nrrd

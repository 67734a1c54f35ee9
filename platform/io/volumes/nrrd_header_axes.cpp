#include "platform/io/volumes/nrrd_header_axes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast::nrrd {

namespace {

Role roleOf(std::string_view kind, bool hasDirections, const Vector& direction) {
    static const std::set<std::string_view> kUnsaid = {"", "???", "none", "domain", "space"};
    if (!kUnsaid.contains(kind) && kind != "time") {
        return Role::Components;
    }
    const bool alongTime = direction && direction->size() > 3 && (*direction)[3] != 0.0 &&
                           spaceOf(*direction) == glm::dvec3(0.0);
    return kind == "time" || alongTime || (hasDirections && !direction) ? Role::Time : Role::Space;
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

} // namespace

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

std::vector<Axis> axesOf(const TextHeader& text, const std::vector<std::int64_t>& sizes) {
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

Result<void> setAxes(const std::filesystem::path& path, FileHeader& header,
                     std::vector<Axis>& axes) {
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

} // namespace slabcast::nrrd

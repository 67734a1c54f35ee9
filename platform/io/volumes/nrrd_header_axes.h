#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "platform/io/volumes/file_header.h"
#include "platform/io/volumes/text_header.h"

namespace slabcast::nrrd {

/// Of "(1,0,0) none (0,0,2)"; `none` is nothing, and what is no number is NaN.
using Vector = std::optional<std::vector<double>>;
std::vector<Vector> parseVectors(std::string_view text);
/// Its first three numbers, with 0 for those that it lacks.
glm::dvec3 spaceOf(const std::vector<double>& vector);

enum class Role : std::uint8_t { Space, Time, Components };

/// One axis of the file, as its fields have it.
struct Axis {
    std::size_t index;
    std::int64_t size;
    Role role;
    bool isList;
};

/// By `kinds` and `space directions`.
std::vector<Axis> axesOf(const TextHeader& text, const std::vector<std::int64_t>& sizes);

/// Leaves those of space, and puts sizes, components and times into the header. Fails:
/// UnsupportedDims (time is not the slowest axis).
Result<void> setAxes(const std::filesystem::path& path, FileHeader& header,
                     std::vector<Axis>& axes);

} // namespace slabcast::nrrd

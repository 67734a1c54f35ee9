#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/load_options.h"
#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

constexpr const char* kExample =
    "expected DIMS,TYPE,SPACING[,le|be], as 256x256x128,uint16,1x1x1.5";

tl::unexpected<Error> wrong(ErrorCode code, std::string_view text, std::string_view why) {
    return fail(code, oneLine(fmt::format("raw layout '{}': {}; {}", text, why, kExample)));
}

Result<glm::i64vec3> parseDims(std::string_view layout, std::string_view text) {
    const std::vector<std::string_view> parts = split(text, 'x');
    if (parts.size() != 3) {
        return wrong(ErrorCode::UnsupportedDims, layout,
                     fmt::format("{} dimensions where a volume has three", parts.size()));
    }
    glm::i64vec3 dims{0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<std::int64_t> size = parseInteger(parts[axis]);
        if (!size) {
            return wrong(ErrorCode::InvalidArgument, layout,
                         fmt::format("'{}' is no dimension", parts[axis]));
        }
        dims[axis] = *size;
    }
    return dims;
}

Result<glm::dvec3> parseSpacing(std::string_view layout, std::string_view text) {
    const std::vector<std::string_view> parts = split(text, 'x');
    glm::dvec3 spacing{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> length =
            parts.size() == 3 ? parseReal(parts[axis]) : std::nullopt;
        if (!length || !std::isfinite(*length) || *length <= 0.0) {
            return wrong(ErrorCode::InvalidGeometry, layout,
                         fmt::format("'{}' is no spacing of three positive lengths in mm", text));
        }
        spacing[axis] = *length;
    }
    return spacing;
}

} // namespace

Result<RawLayout> parseRawLayout(std::string_view text) {
    const std::vector<std::string_view> parts = split(text, ',');
    const std::string_view order = parts.size() == 4 ? trimmed(parts[3]) : "le";
    if (parts.size() < 3 || parts.size() > 4 || (order != "le" && order != "be")) {
        return wrong(ErrorCode::InvalidArgument, text, "does not have the right fields");
    }
    const std::optional<VoxelType> type = parseVoxelType(trimmed(parts[1]));
    if (!type) {
        return wrong(
            ErrorCode::UnsupportedType, text,
            fmt::format("'{}' is no type out of int8, uint8, int16, uint16, int32, uint32, "
                        "float, double",
                        parts[1]));
    }
    const Result<glm::i64vec3> dims = parseDims(text, parts[0]);
    if (!dims) {
        return tl::unexpected(dims.error());
    }
    const Result<glm::dvec3> spacing = parseSpacing(text, parts[2]);
    if (!spacing) {
        return tl::unexpected(spacing.error());
    }
    if (const Result<std::int64_t> bytes = checkedByteCount(*dims, *type); !bytes) {
        return wrong(bytes.error().code, text, bytes.error().detail);
    }
    return RawLayout{*dims, *type, *spacing, order == "be"};
}

std::string textOf(const RawLayout& layout) {
    const glm::dvec3 spacing = layout.spacingMm;
    return fmt::format("{}x{}x{},{},{}x{}x{}{}", layout.dims.x, layout.dims.y, layout.dims.z,
                       name(layout.type), spacing.x, spacing.y, spacing.z,
                       layout.bigEndian ? ",be" : "");
}

Result<std::vector<Selection>> parseSelections(std::string_view text) {
    std::vector<Selection> selections;
    for (const std::string_view part : split(text, ',')) {
        const std::size_t equals = part.find('=');
        const std::string_view key = trimmed(part.substr(0, equals));
        if (equals == std::string_view::npos || key.empty()) {
            return fail(ErrorCode::InvalidArgument,
                        oneLine(fmt::format("'{}' is not KEY=VALUE, as EchoTime=20", text)));
        }
        selections.push_back({std::string(key), std::string(trimmed(part.substr(equals + 1)))});
    }
    return selections;
}

} // namespace slabcast

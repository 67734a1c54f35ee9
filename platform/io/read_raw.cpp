#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "platform/io/parse_text.h"
#include "platform/io/readers.h"

namespace slabcast {

namespace {

constexpr std::int64_t kReadAtOnce = 16 << 20; // bytes
constexpr const char* kExample =
    "expected DIMS,TYPE,SPACING[,le|be], as 256x256x128,uint16,1x1x1.5";

tl::unexpected<Error> wrong(ErrorCode code, std::string_view text, std::string_view why) {
    return fail(code, fmt::format("raw layout '{}': {}; {}", text, why, kExample));
}

void swapBytes(VoxelBytes& voxels, std::size_t size) {
    for (std::byte* voxel = voxels.begin(); voxel != voxels.end(); voxel += size) {
        std::reverse(voxel, voxel + size);
    }
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
                        fmt::format("'{}' is not KEY=VALUE, as EchoTime=20", text));
        }
        selections.push_back({std::string(key), std::string(trimmed(part.substr(equals + 1)))});
    }
    return selections;
}

Result<Volume> readRaw(const std::filesystem::path& path, const LoadOptions& options) {
    const RawLayout& layout = *options.raw;
    const std::int64_t skipBytes = options.rawSkipBytes;
    const Result<std::int64_t> bytes = checkedByteCount(layout.dims, layout.type);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    std::error_code error;
    const auto fileSize = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
    if (error) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: {}; check that --raw is given with a file", path.string(),
                                error.message()));
    }
    const std::int64_t left = fileSize - skipBytes - *bytes;
    if (left != 0) {
        const std::string asked = fmt::format(
            "{}: has {} bytes, {} x {} x {} voxels of {} take {}{}", path.string(), fileSize,
            layout.dims.x, layout.dims.y, layout.dims.z, name(layout.type), *bytes,
            skipBytes > 0 ? fmt::format(" after {} that are skipped", skipBytes) : "");
        return left < 0 ? fail(ErrorCode::FileTruncated,
                               fmt::format("{}: {} are missing; correct the layout given with "
                                           "--raw",
                                           asked, -left))
                        : fail(ErrorCode::InvalidArgument,
                               fmt::format("{}: {} are left over; if they are a header, skip it "
                                           "with --skip-bytes {}, else correct the layout",
                                           asked, left, skipBytes + left));
    }
    Volume volume;
    volume.name = path.filename().string();
    volume.type = layout.type;
    volume.geometry.dims = layout.dims;
    volume.geometry.spacingMm = layout.spacingMm;
    volume.voxels = makeVoxels(options, static_cast<std::size_t>(*bytes));
    std::ifstream file(path, std::ios::binary);
    file.seekg(options.rawSkipBytes);
    for (std::int64_t done = 0; done < *bytes; done += kReadAtOnce) {
        if (const Result<void> on = going(options, path, double(done) / double(*bytes)); !on) {
            return tl::unexpected(on.error());
        }
        if (!file.read(reinterpret_cast<char*>(volume.voxels.data() + done),
                       std::min(kReadAtOnce, *bytes - done))) {
            return fail(ErrorCode::FileUnreadable,
                        fmt::format("{}: cannot be read; check its permissions", path.string()));
        }
    }
    if (layout.bigEndian != (std::endian::native == std::endian::big)) {
        swapBytes(volume.voxels, bytesPerVoxel(layout.type));
    }
    return volume;
}

} // namespace slabcast

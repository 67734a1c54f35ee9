#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/io/volumes/file_header.h"

namespace slabcast {

namespace {

constexpr std::size_t kSpatialAxes = 3;

Result<void> checkSizes(const std::string& path, const std::vector<std::int64_t>& sizes) {
    const std::size_t rank = sizes.size();
    if (rank != kSpatialAxes) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: has {} dimensions ({}), and a volume has three; {}", path,
                                rank, fmt::join(sizes, " x "),
                                rank > kSpatialAxes
                                    ? "extract one time step or component"
                                    : "stack the slices into one file or a folder"));
    }
    for (const std::int64_t size : sizes) {
        if (size <= 0) {
            return fail(ErrorCode::EmptyVolume,
                        fmt::format("{}: a dimension of {} ({}); export the volume again", path,
                                    size, fmt::join(sizes, " x ")));
        }
    }
    return {};
}

Result<void> checkSpacings(const std::string& path, const std::vector<double>& spacings) {
    for (std::size_t axis = 0; axis < std::min(spacings.size(), kSpatialAxes); ++axis) {
        if (!std::isfinite(spacings[axis]) || spacings[axis] == 0.0) {
            return fail(ErrorCode::InvalidGeometry,
                        fmt::format("{}: the spacing of axis {} is {}; correct the header to the "
                                    "distance between voxels in mm",
                                    path, axis, spacings[axis]));
        }
    }
    return {};
}

Result<void> checkType(const std::string& path, const FileHeader& header) {
    if (header.components != 1) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: has {} numbers per voxel ({}), and a volume has one; extract "
                                "one channel or convert to grey",
                                path, header.components, header.typeName));
    }
    if (!header.type) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: voxels of type '{}' are not read; convert them to an integer "
                                "of 8 to 32 bits, float or double",
                                path, header.typeName));
    }
    return {};
}

Result<void> checkEncoding(const std::string& path, const FileHeader& header) {
    const DataEncoding encoding = header.source.encoding;
    const bool isText = encoding == DataEncoding::Text || encoding == DataEncoding::Hex;
    if (encoding == DataEncoding::Other && header.encodingName.starts_with("bz")) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: bzip2 is not read; save it with gzip", path));
    }
    if (encoding == DataEncoding::Other) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: the encoding '{}' is not read; check the field 'encoding', or "
                                "save it as raw or gzip",
                                path, header.encodingName));
    }
    if (isText && header.source.byteSkip < 0) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: a 'byte skip' of {} is for raw voxels, and these are text; "
                                "correct it in the header",
                                path, header.source.byteSkip));
    }
    if (!header.bigEndian && encoding != DataEncoding::Text &&
        bytesPerVoxel(header.type->type) > 1) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: the field 'endian' is missing or unknown, and voxels of {} "
                                "bytes need it; add 'endian: little' or 'endian: big'",
                                path, bytesPerVoxel(header.type->type)));
    }
    return {};
}

/// Of all times together.
Result<void> checkFiles(const std::string& path, const FileHeader& header, std::int64_t bytes) {
    if (header.times <= 0 || bytes > std::numeric_limits<std::int64_t>::max() / header.times) {
        return fail(ErrorCode::SizeOverflow,
                    fmt::format("{}: {} volumes over time, more than can be addressed; check the "
                                "file's header",
                                path, header.times));
    }
    return checkVoxelFiles(path, header.source, *header.type, bytes * header.times);
}

} // namespace

Placement placementOf(const glm::dmat3& stepsMm, glm::dvec3 originMm) {
    Placement placement;
    placement.originMm = originMm + 0.0; // no zeros below zero
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(stepsMm[axis]);
        placement.spacingMm[axis] = length;
        placement.direction[axis] = stepsMm[axis] / length + 0.0;
    }
    return placement;
}

void setAxes(FileHeader& header, const std::vector<std::int64_t>& sizes) {
    header.sizes = sizes;
    const auto isOne = [](std::int64_t size) { return size == 1; };
    while (header.sizes.size() > kSpatialAxes && isOne(header.sizes.back())) {
        header.sizes.pop_back();
    }
    if (header.sizes.size() == kSpatialAxes + 1 && header.sizes.back() > 0) {
        header.times = header.sizes.back();
        header.sizes.pop_back();
    }
}

Result<std::int64_t> check(const std::filesystem::path& path, const FileHeader& header) {
    const std::string name = path.string();
    std::int64_t bytes = 0;
    return checkType(name, header)
        .and_then([&]() { return checkSizes(name, header.sizes); })
        .and_then([&]() { return checkSpacings(name, header.spacings); })
        .and_then([&]() -> Result<void> {
            return header.placement ? Result<void>() : tl::unexpected(header.placement.error());
        })
        .and_then([&]() {
            return checkedByteCount({header.sizes[0], header.sizes[1], header.sizes[2]},
                                    header.type->type);
        })
        .and_then([&](std::int64_t counted) {
            bytes = counted;
            return checkEncoding(name, header);
        })
        .and_then([&]() { return checkFiles(name, header, bytes); })
        .map([&]() { return bytes; })
        .map_error([&](Error error) {
            const bool named = error.detail.starts_with(name);
            return named ? error : Error{error.code, fmt::format("{}: {}", name, error.detail)};
        });
}

} // namespace slabcast

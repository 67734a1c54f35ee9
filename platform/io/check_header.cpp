#include "platform/io/file_header.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

namespace slabcast {

namespace {

constexpr std::size_t kSpatialAxes = 3;
constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kMaxDeflateRatio =
    1032; // RFC 1951 allows no more, so longer data cannot be inside

Result<void> checkSizes(const std::string& path, const std::vector<std::int64_t>& sizes) {
    std::size_t rank = sizes.size();
    while (rank > kSpatialAxes && sizes[rank - 1] == 1) {
        --rank;
    }
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

/// Whether the stream holds `bytes` and ends as it should, checksum included. Goes through all
/// of it.
bool inflates(const FileHeader& header, std::int64_t bytes) {
    constexpr int kZlibOrGzip = 15 + 32; // zlib.h, inflateInit2()
    std::ifstream file(header.dataFile, std::ios::binary);
    file.seekg(header.fileOffset);
    std::vector<char> packed(1 << 18);
    std::vector<char> plain(1 << 18);
    std::int64_t packedLeft = header.deflatedBytes > 0 ? header.deflatedBytes : kUnlimited;
    std::int64_t plainBytes = 0;
    z_stream stream{};
    int status = inflateInit2(&stream, kZlibOrGzip);
    while (status == Z_OK || (status == Z_STREAM_END && plainBytes < bytes)) {
        if (status == Z_STREAM_END) {
            inflateReset(&stream); // gzip files may be strung together
        }
        if (stream.avail_in == 0) {
            file.read(packed.data(), std::min<std::int64_t>(packed.size(), packedLeft));
            packedLeft -= file.gcount();
            stream.next_in = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_in = static_cast<uInt>(file.gcount());
        }
        stream.next_out = reinterpret_cast<Bytef*>(plain.data());
        stream.avail_out = static_cast<uInt>(plain.size());
        status = inflate(&stream, Z_NO_FLUSH); // without input: Z_BUF_ERROR, which ends the loop
        plainBytes += static_cast<std::int64_t>(plain.size()) - stream.avail_out;
    }
    inflateEnd(&stream);
    return status == Z_STREAM_END && plainBytes >= bytes;
}

Result<void> checkDataSize(const std::string& path, const FileHeader& header, std::int64_t bytes) {
    if (header.dataFile.empty() || header.encoding == DataEncoding::Other) {
        return {};
    }
    std::error_code error;
    const auto fileSize =
        static_cast<std::int64_t>(std::filesystem::file_size(header.dataFile, error));
    if (error) {
        return fail(ErrorCode::FileNotFound,
                    fmt::format("{}: its voxels should be in {}, which is not there; keep both "
                                "files in one folder",
                                path, header.dataFile.string()));
    }
    const bool raw = header.encoding == DataEncoding::Raw;
    if (raw ? fileSize - header.fileOffset < bytes : fileSize < bytes / kMaxDeflateRatio) {
        return fail(
            ErrorCode::FileTruncated,
            fmt::format("{}: the header asks for {} bytes of voxels, {} has {} bytes in all; "
                        "fetch the file again or correct the sizes in the header",
                        path, bytes, header.dataFile.string(), fileSize));
    }
    if (!raw && !inflates(header, header.inflatedOffset + bytes)) {
        return fail(
            ErrorCode::FileTruncated,
            fmt::format("{}: the compressed voxels in {} end early or are damaged; fetch the "
                        "file again or correct the sizes in the header",
                        path, header.dataFile.string()));
    }
    return {};
}

} // namespace

Result<void> check(const std::filesystem::path& path, const FileHeader& header) {
    const std::string name = path.string();
    if (header.components != 1) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: has {} numbers per voxel, and a volume has one; extract one "
                                "channel or convert to grey",
                                name, header.components));
    }
    if (!header.typeKnown) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: voxels of type '{}' are not read; convert them to an integer "
                                "of 8 to 32 bits, float or double",
                                name, header.typeName));
    }
    return checkSizes(name, header.sizes)
        .and_then([&]() { return checkSpacings(name, header.spacings); })
        .and_then([&]() {
            return checkedByteCount({header.sizes[0], header.sizes[1], header.sizes[2]},
                                    header.type);
        })
        .and_then([&](std::int64_t bytes) { return checkDataSize(name, header, bytes); })
        .map_error([&](Error error) {
            const bool named = error.detail.starts_with(name);
            return named ? error : Error{error.code, fmt::format("{}: {}", name, error.detail)};
        });
}

} // namespace slabcast

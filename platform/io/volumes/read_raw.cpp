#include <algorithm>
#include <array>
#include <bit>
#include <fstream>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"

namespace slabcast {

namespace {

constexpr std::int64_t kReadAtOnce = 16 << 20; // bytes
void swapBytes(VoxelBytes& voxels, std::size_t size) {
    for (std::byte* voxel = voxels.begin(); voxel != voxels.end(); voxel += size) {
        std::reverse(voxel, voxel + size);
    }
}

} // namespace

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
                        : fail(ErrorCode::FileUnreadable,
                               fmt::format("{}: {} are left over; if they are a header, skip it "
                                           "with --skip-bytes {}, else correct the layout",
                                           asked, left, skipBytes + left));
    }
    Volume volume;
    volume.name = path.filename().string();
    volume.type = layout.type;
    volume.geometry.dims = layout.dims;
    volume.geometry.spacingMm = layout.spacingMm;
    if (const Result<void> wanted = admitted(options, volume); !wanted) {
        return tl::unexpected(wanted.error());
    }
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

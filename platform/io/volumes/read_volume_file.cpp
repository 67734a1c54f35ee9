#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"
#include "platform/io/volumes/file_header.h"
#include "platform/io/volumes/stored_values.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;

/// Which of the volumes over time to take.
Result<std::int64_t> chooseTime(const Path& path, const FileHeader& header,
                                const LoadOptions& options) {
    if (options.time && (*options.time < 0 || *options.time >= header.times)) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: holds {} volumes over time, and number {} was asked for; "
                                "name one from 0 to {}",
                                path.string(), header.times, *options.time, header.times - 1));
    }
    if (!options.time && header.times > 1) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: holds {} volumes over time; take one with --time 0 to --time "
                                "{}, or extract one",
                                path.string(), header.times, header.times - 1));
    }
    return options.time.value_or(0);
}

VolumeGeometry geometryOf(const FileHeader& header) {
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(header.sizes[0], header.sizes[1], header.sizes[2]);
    geometry.spacingMm = header.placement->spacingMm;
    geometry.originMm = header.placement->originMm;
    geometry.direction = header.placement->direction;
    return geometry;
}

/// Straight into the end of what the volume will hold: rescaled voxels may be longer than stored
/// ones, and then grow to the front.
Result<void> readVoxels(const Path& path, const FileHeader& header, std::int64_t bytes,
                        std::int64_t time, const LoadOptions& options, Volume& volume) {
    const StoredType stored = *header.type;
    const Rescaling rescaling{header.slope, header.intercept};
    volume.type = rescaling.changes() ? rescaledType(stored) : stored.type;
    const auto count = static_cast<std::size_t>(volume.geometry.voxelCount());
    const auto storedBytes = static_cast<std::size_t>(bytes);
    if (const Result<void> wanted = admitted(options, volume); !wanted) {
        return wanted;
    }
    volume.voxels = makeVoxels(options, count * bytesPerVoxel(volume.type));
    VoxelSource source = header.source;
    source.bigEndian = header.bigEndian.value_or(false);
    const Result<void> read =
        readVoxelBytes(path.string(), source, stored, bytes * header.times, bytes * time,
                       std::span(volume.voxels).last(storedBytes),
                       [&](const Path& file, double done) { return going(options, file, done); });
    if (!read) {
        return read;
    }
    if (rescaling.changes()) {
        rescale(volume.voxels, stored, rescaling);
    } else if (stored.wide != Wide::No) {
        const Result<VoxelType> type = narrow(volume.voxels, stored.wide);
        if (!type) {
            return fail(type.error().code,
                        fmt::format("{}: {}", path.string(), type.error().detail));
        }
        volume.type = *type;
    }
    return {};
}

Result<Volume> readVolume(const Path& path, const Result<FileHeader>& header,
                          const LoadOptions& options) {
    if (!header) {
        return tl::unexpected(header.error());
    }
    const Result<std::int64_t> bytes = check(path, *header);
    const Result<std::int64_t> time = chooseTime(path, *header, options);
    if (!bytes || !time) {
        const bool several = bytes || (header->type && header->components == 1 &&
                                       header->sizes.size() == 3 && header->times > 1);
        return tl::unexpected(!time && several ? time.error() : bytes.error());
    }
    Volume volume;
    volume.name = path.filename().string();
    volume.unit = header->unit;
    volume.modality = header->modality;
    volume.geometry = geometryOf(*header);
    volume.notes = header->notes;
    const Result<void> read = readVoxels(path, *header, *bytes, *time, options, volume);
    return read ? Result<Volume>(std::move(volume)) : tl::unexpected(read.error());
}

/// The header of a pair, whichever of the two is named.
Path headerOfPair(const Path& path) {
    const std::string name = path.string();
    const std::string lower = lowerCase(name);
    const std::size_t ending = lower.ends_with(".img")      ? name.size() - 4
                               : lower.ends_with(".img.gz") ? name.size() - 7
                                                            : std::string::npos;
    std::error_code error;
    for (const char* header : {".hdr", ".HDR", ".hdr.gz"}) {
        const Path candidate(name.substr(0, ending) + header);
        if (ending != std::string::npos && std::filesystem::exists(candidate, error)) {
            return candidate;
        }
    }
    return path;
}

} // namespace

Result<Volume> readNrrd(const Path& path, const LoadOptions& options) {
    return readVolume(path, readNrrdHeader(path), options);
}

Result<Volume> readNifti(const Path& path, const LoadOptions& options) {
    const Path header = headerOfPair(path);
    return readVolume(header, readNiftiHeader(header), options);
}

Result<Volume> readMetaImage(const Path& path, const LoadOptions& options) {
    return readVolume(path, readMetaHeader(path), options);
}

} // namespace slabcast

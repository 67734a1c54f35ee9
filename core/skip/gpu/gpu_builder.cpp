#include "core/skip/gpu/gpu_builder.h"

#include <algorithm>
#include <string>

#include "core/gl/debug.h"
#include "core/gl/state_guard.h"
#include "core/skip/gpu/gpu_distances.h"
#include "core/skip/partitioned_maps.h"

namespace slabcast {

namespace {

struct Need {
    const char* what;
    std::int64_t gl::Caps::*limit;
    std::int64_t least;
};

constexpr Need kNeeds[] = {
    {"compute invocations in a workgroup", &gl::Caps::maxComputeInvocations, kLeavesThreads},
    {"bytes of shared memory in a workgroup", &gl::Caps::maxComputeSharedBytes,
     leavesSharedBytes()},
    {"images in a compute shader", &gl::Caps::maxComputeImages, 1},
    {"storage buffers in a compute shader", &gl::Caps::maxComputeStorageBlocks, 1},
};

/// Fails: DeviceOutOfMemory, Internal.
Result<gl::Buffer> makeStorage(const char* label, std::int64_t bytes) {
    gl::takeError();
    gl::Buffer buffer = gl::Buffer::make(label);
    gl::BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.id());
    gl::BufferData(GL_SHADER_STORAGE_BUFFER, GLsizeiptr(bytes), nullptr, GL_DYNAMIC_COPY);
    return takeUploadError(label).map([&] { return std::move(buffer); });
}

} // namespace

Result<GpuSkipBuilder> GpuSkipBuilder::create(const gl::Caps& caps) {
    for (const auto& [what, limit, least] : kNeeds) {
        if (caps.*limit < least) {
            return fail(ErrorCode::DeviceUnsupported,
                        "building skip structures on the GPU takes " + std::to_string(least) + " " +
                            what + ", the device has " + std::to_string(caps.*limit) +
                            "; they are built on the CPU");
        }
    }
    return GpuSkipBuilder(caps);
}

GpuSkipBuilder::GpuSkipBuilder(const gl::Caps& caps)
    : caps_(caps), found_(gl::Buffer::make("occupied blocks found")) {}

void GpuSkipBuilder::clearFound() const {
    const std::uint32_t none = 0;
    gl::BindBuffer(GL_SHADER_STORAGE_BUFFER, found_.id());
    gl::BufferData(GL_SHADER_STORAGE_BUFFER, sizeof(none), &none, GL_DYNAMIC_COPY);
}

Result<SkipTexture> GpuSkipBuilder::freeLengths(const GpuVoxels& voxels,
                                                const CellVisibility& visibility,
                                                const VolumeGeometry& geometry,
                                                const SkipOptions& options) {
    const gl::StateGuard guard;
    clearFound();
    const int edge = options.blockEdgeVoxels;
    const glm::ivec3 blocks = blocksOf(voxels.dims, edge);
    Result<SkipTexture> marks =
        buildPyramid(programs_, caps_, voxels, rangesOf(visibility),
                     {.edgeVoxels = edge, .layout = freeLengthLayout(blocks)}, found_);
    if (!marks) {
        return tl::unexpected(marks.error());
    }
    switch (options.structure) {
    case SkipStructure::Blocks:
        return blocksFromMarks(programs_, caps_, *marks, blocks);
    case SkipStructure::Chebyshev:
        return chebyshevFromMarks(programs_, caps_, std::move(*marks), blocks);
    case SkipStructure::Proximity:
        return proximityFromMarks(programs_, caps_, *marks, blocks, proximityUnits(geometry, edge),
                                  found_);
    default:
        contractBreach(__func__, "a structure of free lengths under one TF",
                       static_cast<double>(options.structure));
    }
}

Result<SkipTexture> GpuSkipBuilder::booleanOctree(const GpuVoxels& voxels,
                                                  const CellVisibility& visibility,
                                                  const SkipOptions& options) {
    return octree(voxels, rangesOf(visibility), NodeContent::Occupied, 8, options);
}

Result<SkipTexture> GpuSkipBuilder::minMaxOctree(const GpuVoxels& voxels,
                                                 const SkipOptions& options) {
    return octree(voxels, {}, NodeContent::Range, 32, options);
}

Result<SkipTexture> GpuSkipBuilder::bitfieldOctree(const GpuVoxels& voxels, const ValueBins& bins,
                                                   const SkipOptions& options) {
    SLABCAST_EXPECTS(bins.count == options.bits && bins.count <= 128, bins.count);
    return octree(voxels, rangesOf(bins), NodeContent::Bits, options.bits, options);
}

Result<SkipTexture> GpuSkipBuilder::octree(const GpuVoxels& voxels, const RangeTable& table,
                                           NodeContent content, int bits,
                                           const SkipOptions& options) {
    const gl::StateGuard guard;
    clearFound();
    const glm::ivec3 leaves = blocksOf(voxels.dims, options.blockEdgeVoxels);
    return buildPyramid(
        programs_, caps_, voxels, table,
        {.content = content,
         .edgeVoxels = options.blockEdgeVoxels,
         .layout = octreeLayout(leaves, keptLevels(leaves, options.initialLevel), bits)},
        found_);
}

Result<GpuPartitions> GpuSkipBuilder::partitions(const GpuVoxels& voxels, const ValueBins& bins,
                                                 const SkipOptions& options) {
    SLABCAST_EXPECTS(bins.count == options.partitions, bins.count);
    const int edge = options.blockEdgeVoxels;
    GpuPartitions result{
        blocksOf(voxels.dims, edge), edge, bins.count, {}, partitionBytes(voxels.dims, options)};
    if (Result<void> fits = checkPartitions(options, result.bytes, budgetOf(options)).and_then([&] {
            return checkPartitions(
                options, result.bytes,
                {caps_.maxStorageBlockBytes, "the device's limit of a storage block",
                 "take fewer partitions or a larger block edge, or build on the CPU"});
        });
        !fits) {
        return tl::unexpected(fits.error());
    }
    const gl::StateGuard guard;
    Result<gl::Buffer> maps = makeStorage("partitioned maps", result.bytes);
    if (!maps) {
        return tl::unexpected(maps.error());
    }
    result.maps = std::move(*maps);
    return buildPyramid(programs_, caps_, voxels, rangesOf(bins),
                        {.content = NodeContent::Range,
                         .edgeVoxels = edge,
                         .layout = gridLayout(result.blocks, 32)},
                        found_)
        .and_then([&](const SkipTexture& ranges) {
            return chebyshevOfPartitions(programs_, caps_, ranges, result.blocks, result.count,
                                         result.maps);
        })
        .map([&] { return std::move(result); });
}

Result<void> GpuSkipBuilder::merge(const GpuPartitions& partitions, const BinSet& set,
                                   SkipTexture& into) {
    const gl::StateGuard guard;
    const SkipLayout layout = freeLengthLayout(partitions.blocks);
    if (!into.texture) {
        Result<SkipTexture> made = allocateSkip("merged free lengths", layout, caps_);
        if (!made) {
            return tl::unexpected(made.error());
        }
        into = std::move(*made);
    }
    SLABCAST_EXPECTS(into.bytes == layout.bytes(), into.bytes);
    const Result<const gl::Program*> program = programs_.use(mergePass());
    if (!program) {
        return tl::unexpected(program.error());
    }
    gl::BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, partitions.maps.id());
    bindOutput(into.texture, GL_R32UI);
    gl::Uniform4uiv((*program)->uniform("partitionSet"), 2, set.data());
    setUniform(**program, "blocks", partitions.blocks);
    runPerTexel(**program, layout.texels);
    return {};
}

void GpuSkipBuilder::forget() {
    programs_.forget();
    found_.forget();
}

std::int64_t partitionBytes(glm::ivec3 dims, const SkipOptions& options) {
    return freeLengthLayout(blocksOf(dims, options.blockEdgeVoxels)).bytes() * options.partitions;
}

} // namespace slabcast

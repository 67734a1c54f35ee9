#include "core/skip/gpu/gpu_download.h"

#include <algorithm>

#include "core/gl/debug.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

/// The words of a texture's texels, x fastest: of each as many as it holds of a node, or one of
/// several nodes. Integer targets are always read as four components, a slice at a time here.
Result<std::vector<std::uint32_t>> readTexels(const gl::Texture& texture,
                                              const SkipLayout& layout) {
    const glm::ivec3 texels = layout.texels;
    std::vector<glm::uvec4> slice(std::size_t(texels.x) * texels.y);
    std::vector<std::uint32_t> words;
    words.reserve(slice.size() * texels.z * layout.wordsPerTexel());
    for (int z = 0; z < texels.z; ++z) {
        gl::FramebufferTextureLayer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.id(), 0, z);
        if (gl::CheckFramebufferStatus(GL_READ_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            return fail(ErrorCode::DeviceUnsupported,
                        "the device does not read slices of skip textures; build on the CPU");
        }
        gl::ReadPixels(0, 0, texels.x, texels.y, GL_RGBA_INTEGER, GL_UNSIGNED_INT, slice.data());
        for (const glm::uvec4& texel : slice) {
            for (int w = 0; w < layout.wordsPerTexel(); ++w) {
                words.push_back(layout.bits == 64 ? texel[2 * w] | texel[2 * w + 1] << 16
                                                  : texel[w]);
            }
        }
    }
    return words;
}

/// The words of a level's nodes, without what fills up its rows.
std::vector<std::uint32_t> nodesOf(const std::vector<std::uint32_t>& texels,
                                   const SkipLayout& layout, const SkipLevel& level,
                                   glm::ivec3 nodes) {
    const int perNode = layout.wordsPerTexel();
    const std::uint32_t mask = ~0U >> (32 - std::min(layout.bits, 32));
    const std::uint32_t* row = texels.data() + std::int64_t(level.first) * perNode;
    std::vector<std::uint32_t> words;
    words.reserve(std::size_t(nodes.x) * nodes.y * nodes.z * perNode);
    for (std::int64_t rows = std::int64_t(nodes.y) * nodes.z; rows > 0; --rows) {
        if (layout.perTexel == 1) {
            words.insert(words.end(), row, row + nodes.x * perNode);
        } else {
            for (int x = 0; x < nodes.x; ++x) {
                words.push_back(row[x / layout.perTexel] >> (x % layout.perTexel * layout.bits) &
                                mask);
            }
        }
        row += std::int64_t(level.texels.x) * perNode;
    }
    return words;
}

} // namespace

Result<std::vector<std::uint32_t>> downloadTexels(const SkipTexture& structure,
                                                  const SkipLayout& layout) {
    const gl::StateGuard guard;
    gl::StateGuard::usePlainPacking();
    gl::takeError();
    gl::MemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
    const gl::Framebuffer target = gl::Framebuffer::make("skip download");
    gl::BindFramebuffer(GL_READ_FRAMEBUFFER, target.id());
    auto words = readTexels(structure.texture, layout);
    const Result<void> error = takeUploadError("a downloaded skip structure");
    return error ? std::move(words) : tl::unexpected(error.error());
}

Result<FreeLengths> downloadFreeLengths(const SkipTexture& lengths, glm::ivec3 blocks,
                                        int blockEdgeVoxels, double quantumMm) {
    const SkipLayout layout = freeLengthLayout(blocks);
    return downloadTexels(lengths, layout).map([&](const std::vector<std::uint32_t>& texels) {
        const std::vector<std::uint32_t> counts =
            nodesOf(texels, layout, layout.levels.front(), blocks);
        FreeLengths result{blocks, blockEdgeVoxels, quantumMm, {counts.begin(), counts.end()}, 0};
        result.occupiedBlocks = std::count(counts.begin(), counts.end(), 0U);
        return result;
    });
}

Result<Octree> downloadOctree(const SkipTexture& octree, NodeContent content, int bitsPerNode,
                              int leafEdgeVoxels, glm::ivec3 leaves, int levels) {
    const SkipLayout layout = octreeLayout(leaves, levels, bitsPerNode);
    return downloadTexels(octree, layout).map([&](const std::vector<std::uint32_t>& texels) {
        Octree result{content, leafEdgeVoxels, bitsPerNode, {}};
        for (int level = 0; level < levels; ++level) {
            const glm::ivec3 nodes = blocksOf(leaves, 1 << level);
            result.levels.push_back({nodes, nodesOf(texels, layout, layout.levels[level], nodes)});
        }
        return result;
    });
}

Result<std::vector<std::uint8_t>> downloadDistances(const GpuPartitions& partitions) {
    const gl::StateGuard guard;
    gl::MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl::BindBuffer(GL_SHADER_STORAGE_BUFFER, partitions.maps.id());
    const auto* bytes = static_cast<const std::uint8_t*>(gl::MapBufferRange(
        GL_SHADER_STORAGE_BUFFER, 0, GLsizeiptr(partitions.bytes), GL_MAP_READ_BIT));
    if (bytes == nullptr) {
        return fail(ErrorCode::Internal, "the GPU's partitioned maps cannot be read (" +
                                             gl::errorName(gl::takeError()) + ")");
    }
    const glm::ivec3 blocks = partitions.blocks;
    const int rowBytes = freeLengthLayout(blocks).texels.x * 4;
    std::vector<std::uint8_t> distances;
    distances.reserve(std::size_t(blocks.x) * blocks.y * blocks.z * partitions.count);
    for (std::int64_t at = 0; at < partitions.bytes; at += rowBytes) {
        distances.insert(distances.end(), bytes + at, bytes + at + blocks.x);
    }
    gl::UnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    return distances;
}

} // namespace slabcast

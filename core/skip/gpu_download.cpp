#include "core/skip/gpu_download.h"

#include <algorithm>

#include "core/gl/debug.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

/// Components of one level's texels, four to each, x fastest: what integer targets are always read
/// as.
Result<std::vector<glm::uvec4>> readLevel(const gl::Texture& texture, const SkipLayout& layout,
                                          int level) {
    const glm::ivec3 texels = layout.texelsOf(level);
    const std::int64_t perSlice = std::int64_t(texels.x) * texels.y;
    std::vector<glm::uvec4> components(perSlice * texels.z);
    for (int z = 0; z < texels.z; ++z) {
        gl::FramebufferTextureLayer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.id(), level,
                                    z);
        if (gl::CheckFramebufferStatus(GL_READ_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            return fail(ErrorCode::DeviceUnsupported,
                        "the device does not read slices of skip textures; build on the CPU");
        }
        gl::ReadPixels(0, 0, texels.x, texels.y, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                       components.data() + z * perSlice);
    }
    return components;
}

/// Calls read(texture) with the levels to come from its slices.
template <class Read>
auto withReadTarget(Read read) {
    const gl::StateGuard guard;
    gl::StateGuard::usePlainPixelTransfer();
    gl::takeError();
    gl::MemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
    const gl::Framebuffer target = gl::Framebuffer::make("skip download");
    gl::BindFramebuffer(GL_READ_FRAMEBUFFER, target.id());
    auto result = read();
    const Result<void> error = takeUploadError("a downloaded skip structure");
    return error ? result : decltype(result)(tl::unexpected(error.error()));
}

/// Word w of a node, from its texel's components.
std::uint32_t wordOf(const glm::uvec4& texel, const SkipLayout& layout, int x, int w) {
    if (layout.bits < 32) {
        return texel.x >> (x % layout.perTexel * layout.bits) & ((1U << layout.bits) - 1U);
    }
    return layout.bits == 64 ? texel[2 * w] | texel[2 * w + 1] << 16 : texel[w];
}

/// The words of nodes, without padding.
std::vector<std::uint32_t> unpacked(const std::vector<glm::uvec4>& components,
                                    const SkipLayout& layout, int level, glm::ivec3 nodes) {
    const glm::ivec3 texels = layout.texelsOf(level);
    std::vector<std::uint32_t> words;
    words.reserve(std::size_t(nodes.x) * nodes.y * nodes.z * layout.wordsPerTexel());
    for (int z = 0; z < nodes.z; ++z) {
        for (int y = 0; y < nodes.y; ++y) {
            const glm::uvec4* row = components.data() + (std::int64_t(z) * texels.y + y) * texels.x;
            for (int x = 0; x < nodes.x; ++x) {
                for (int w = 0; w < layout.wordsPerTexel(); ++w) {
                    words.push_back(wordOf(row[x / layout.perTexel], layout, x, w));
                }
            }
        }
    }
    return words;
}

} // namespace

Result<FreeLengths> downloadFreeLengths(const SkipTexture& lengths, glm::ivec3 blocks,
                                        int blockEdgeVoxels, double quantumMm) {
    const SkipLayout layout = freeLengthLayout(blocks);
    return withReadTarget([&] { return readLevel(lengths.texture, layout, 0); })
        .map([&](const std::vector<glm::uvec4>& components) {
            const std::vector<std::uint32_t> words = unpacked(components, layout, 0, blocks);
            FreeLengths result{blocks, blockEdgeVoxels, quantumMm, {words.begin(), words.end()}, 0};
            result.occupiedBlocks = std::count(words.begin(), words.end(), 0U);
            return result;
        });
}

Result<Octree> downloadOctree(const SkipTexture& octree, NodeContent content, int bitsPerNode,
                              int leafEdgeVoxels, glm::ivec3 leaves, int levels) {
    const SkipLayout layout = octreeLayout(leaves, levels, bitsPerNode);
    return withReadTarget([&]() -> Result<Octree> {
        Octree result{content, leafEdgeVoxels, bitsPerNode, {}};
        for (int level = 0; level < levels; ++level) {
            const auto components = readLevel(octree.texture, layout, level);
            if (!components) {
                return tl::unexpected(components.error());
            }
            const glm::ivec3 nodes = blocksOf(leaves, 1 << level);
            result.levels.push_back({nodes, unpacked(*components, layout, level, nodes)});
        }
        return result;
    });
}

Result<std::vector<std::uint8_t>> downloadDistances(const GpuPartitions& partitions) {
    const gl::StateGuard guard;
    gl::MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl::BindBuffer(GL_SHADER_STORAGE_BUFFER, partitions.maps.id());
    const auto* bytes = static_cast<const std::uint8_t*>(
        gl::MapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, partitions.bytes, GL_MAP_READ_BIT));
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

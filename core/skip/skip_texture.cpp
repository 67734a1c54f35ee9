#include "core/skip/skip_texture.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace slabcast {

namespace {

constexpr TexelLayout kLayouts[] = {
    {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, GL_NEAREST, 4},
    {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, GL_NEAREST, 8},
    {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, GL_NEAREST, 16},
};
// Bytes and halves lie in a word with the low one first.
static_assert(std::endian::native == std::endian::little);

int roundUp(int value, int multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

std::int64_t volumeOf(glm::ivec3 size) {
    return std::int64_t(size.x) * size.y * size.z;
}

/// One level's texels; `empty` fills what lies beyond the values.
template <class Value>
std::vector<std::uint32_t> packed(std::span<const Value> values, glm::ivec3 size,
                                  const SkipLayout& layout, int level, std::uint32_t empty) {
    const glm::ivec3 texels = layout.texelsOf(level);
    const int words = layout.wordsPerTexel();
    std::uint32_t emptyTexel = 0;
    for (int i = 0; i < layout.perTexel; ++i) {
        emptyTexel |= empty << (i * layout.bits);
    }
    std::vector<std::uint32_t> out(volumeOf(texels) * words, emptyTexel);
    const std::int64_t rowWords = std::int64_t(size.x) * words;
    const Value* row = values.data();
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y, row += rowWords) {
            std::uint32_t* texel = out.data() + (std::int64_t(z) * texels.y + y) * texels.x * words;
            if (int(sizeof(Value)) * 8 == std::min(layout.bits, 32)) {
                std::memcpy(texel, row, rowWords * sizeof(Value)); // lies in memory as it should
                continue;
            }
            for (int x = 0; x < size.x; ++x) { // narrow nodes are empty as zeros
                texel[x / layout.perTexel] |= std::uint32_t(row[x])
                                              << (x % layout.perTexel * layout.bits);
            }
        }
    }
    return out;
}

Result<SkipTexture> upload(const char* label, const SkipLayout& layout,
                           const std::vector<std::vector<std::uint32_t>>& levels,
                           const gl::Caps& caps) {
    if (Result<void> fits = checkFits(layout, caps); !fits) {
        return tl::unexpected(fits.error());
    }
    std::vector<const void*> data;
    for (const std::vector<std::uint32_t>& level : levels) {
        data.push_back(level.data());
    }
    return uploadLevels3d(label, texelLayoutOf(layout), layout.texels, data)
        .map([&](gl::Texture&& texture) {
            return SkipTexture{std::move(texture), layout.bytes()};
        });
}

SkipLayout layoutOf(const Octree& octree) {
    return octreeLayout(octree.levels.front().nodes, int(octree.levels.size()), octree.bitsPerNode);
}

} // namespace

std::int64_t SkipLayout::bytes() const {
    std::int64_t texelCount = 0;
    for (int level = 0; level < levels; ++level) {
        texelCount += volumeOf(texelsOf(level));
    }
    return texelCount * texelLayoutOf(*this).bytesPerTexel;
}

SkipLayout freeLengthLayout(glm::ivec3 blocks) {
    return octreeLayout(blocks, 1, 8);
}

SkipLayout octreeLayout(glm::ivec3 leaves, int levels, int bitsPerNode) {
    const int perTexel = bitsPerNode < 32 ? 32 / bitsPerNode : 1;
    const int multiple = 1 << (levels - 1);
    return {bitsPerNode, perTexel,
            glm::ivec3(roundUp(leaves.x, perTexel * multiple) / perTexel,
                       roundUp(leaves.y, multiple), roundUp(leaves.z, multiple)),
            levels};
}

std::uint32_t emptyNode(NodeContent content) {
    return content == NodeContent::Range ? 0x0000ffffU : 0U;
}

const TexelLayout& texelLayoutOf(const SkipLayout& layout) {
    return kLayouts[layout.bits <= 32 ? 0 : layout.bits / 64];
}

std::int64_t gpuBytes(const FreeLengths& lengths) {
    return freeLengthLayout(lengths.blocks).bytes();
}

std::int64_t gpuBytes(const Octree& octree) {
    return layoutOf(octree).bytes();
}

Result<void> checkFits(const SkipLayout& layout, const gl::Caps& caps) {
    const int longest = std::max({layout.texels.x, layout.texels.y, layout.texels.z});
    if (longest <= caps.maxTexture3DSize) {
        return {};
    }
    return fail(ErrorCode::VolumeTooLarge,
                "the skip structure has " + std::to_string(longest) +
                    " texels along an edge, the device's 3D textures end at " +
                    std::to_string(caps.maxTexture3DSize) + "; give it longer blocks or leaves");
}

Result<SkipTexture> uploadFreeLengths(const FreeLengths& lengths, const gl::Caps& caps) {
    SLABCAST_EXPECTS(volumeOf(lengths.blocks) == std::int64_t(lengths.counts.size()),
                     lengths.counts.size());
    const SkipLayout layout = freeLengthLayout(lengths.blocks);
    const std::span<const std::uint8_t> counts = lengths.counts;
    return upload("free lengths", layout, {packed(counts, lengths.blocks, layout, 0, 0)}, caps);
}

Result<SkipTexture> uploadOctree(const Octree& octree, const gl::Caps& caps) {
    const SkipLayout layout = layoutOf(octree);
    std::vector<std::vector<std::uint32_t>> levels;
    for (const OctreeLevel& level : octree.levels) {
        const std::span<const std::uint32_t> words = level.words;
        levels.push_back(
            packed(words, level.nodes, layout, int(levels.size()), emptyNode(octree.content)));
    }
    return upload("octree", layout, levels, caps);
}

} // namespace slabcast

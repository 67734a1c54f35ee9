#include "core/skip/gpu/skip_texture.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
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

constexpr const char* kFreeLengths = "free lengths"; // in messages

/// A level's values in its place among `words`, which hold zeros. Narrow values are empty as zeros.
template <class Value>
void pack(std::span<const Value> values, glm::ivec3 size, const SkipLayout& layout,
          const SkipLevel& level, std::uint32_t* words) {
    const int wordsPerTexel = layout.wordsPerTexel();
    const std::int64_t rowWords = std::int64_t(size.x) * wordsPerTexel;
    std::uint32_t* to = words + std::int64_t(level.first) * wordsPerTexel;
    const Value* row = values.data();
    for (std::int64_t rows = std::int64_t(size.y) * size.z; rows > 0; --rows) {
        if (int(sizeof(Value)) * 8 == std::min(layout.bits, 32)) {
            std::memcpy(to, row,
                        std::size_t(rowWords) * sizeof(Value)); // lies in memory as it should
        } else {
            for (int x = 0; x < size.x; ++x) {
                to[x / layout.perTexel] |= std::uint32_t(row[x])
                                           << (x % layout.perTexel * layout.bits);
            }
        }
        row += rowWords;
        to += std::int64_t(level.texels.x) * wordsPerTexel;
    }
}

std::vector<std::uint32_t> noWords(const SkipLayout& layout) {
    return std::vector<std::uint32_t>(std::size_t(layout.texelCount() * layout.wordsPerTexel()));
}

} // namespace

const TexelLayout& texelLayoutOf(const SkipLayout& layout) {
    return kLayouts[layout.bits <= 32 ? 0 : layout.bits / 64];
}

Result<void> checkFits(const SkipLayout& layout, const gl::Caps& caps) {
    const auto tooLarge = [](const std::string& what) {
        return fail(ErrorCode::VolumeTooLarge,
                    "the skip structure has " + what + "; give it longer blocks or leaves");
    };
    const int longest = std::max({layout.texels.x, layout.texels.y, layout.texels.z});
    if (longest > caps.maxTexture3DSize) {
        return tooLarge(std::to_string(longest) +
                        " texels along an edge, the device's 3D textures end at " +
                        std::to_string(caps.maxTexture3DSize));
    }
    constexpr int kMost = std::numeric_limits<int>::max();
    if (layout.texelCount() > kMost) {
        return tooLarge(std::to_string(layout.texelCount()) + " texels, shaders count to " +
                        std::to_string(kMost));
    }
    return {};
}

Result<SkipTexture> allocateSkip(const char* label, const SkipLayout& layout,
                                 const gl::Caps& caps) {
    return checkFits(layout, caps)
        .and_then([&] { return allocate3d(label, texelLayoutOf(layout), layout.texels); })
        .map([&](gl::Texture&& texture) {
            return SkipTexture{std::move(texture), layout.bytes()};
        });
}

Result<SkipTexture> allocateFreeLengths(glm::ivec3 blocks, const gl::Caps& caps) {
    return allocateSkip(kFreeLengths, freeLengthLayout(blocks), caps);
}

Result<void> uploadSlices(const SkipTexture& into, const FreeLengths& lengths, int begin, int end) {
    const glm::ivec3 size(lengths.blocks.x, lengths.blocks.y, end - begin);
    const std::int64_t perSlice = std::int64_t(size.x) * size.y;
    SLABCAST_EXPECTS(perSlice * lengths.blocks.z == std::int64_t(lengths.counts.size()) &&
                         begin >= 0 && begin < end && end <= lengths.blocks.z,
                     end);
    const SkipLayout layout = freeLengthLayout(size);
    const std::span<const std::uint8_t> counts(lengths.counts);
    std::vector<std::uint32_t> words = noWords(layout);
    pack(counts.subspan(std::size_t(begin * perSlice), std::size_t(size.z * perSlice)), size,
         layout, layout.levels.front(), words.data());
    return fillSlices(kFreeLengths, into.texture, texelLayoutOf(layout), {layout.texels, begin},
                      words.data());
}

Result<SkipTexture> uploadFreeLengths(const FreeLengths& lengths, const gl::Caps& caps) {
    Result<SkipTexture> made = allocateFreeLengths(lengths.blocks, caps);
    if (!made) {
        return made;
    }
    return uploadSlices(*made, lengths, 0, lengths.blocks.z).map([&] { return std::move(*made); });
}

Result<SkipTexture> uploadOctree(const Octree& octree, const gl::Caps& caps) {
    const SkipLayout layout = layoutOf(octree);
    constexpr const char* kOctree = "octree";
    Result<SkipTexture> made = allocateSkip(kOctree, layout, caps); // or it is too large to pack
    if (!made) {
        return made;
    }
    std::vector<std::uint32_t> words = noWords(layout);
    for (std::size_t i = 0; i < octree.levels.size(); ++i) {
        const OctreeLevel& level = octree.levels[i];
        pack(std::span<const std::uint32_t>(level.words), level.nodes, layout, layout.levels[i],
             words.data());
    }
    return fillSlices(kOctree, made->texture, texelLayoutOf(layout), {layout.texels}, words.data())
        .map([&] { return std::move(*made); });
}

} // namespace slabcast

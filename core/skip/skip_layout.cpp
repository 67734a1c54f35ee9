#include "core/skip/skip_layout.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/skip/skip_structure.h"

namespace slabcast {

namespace {

std::int64_t volumeOf(glm::ivec3 size) {
    return std::int64_t(size.x) * size.y * size.z;
}

glm::ivec3 texelsOf(glm::ivec3 values, int perTexel) {
    return {(values.x + perTexel - 1) / perTexel, values.y, values.z};
}

/// Width and height of a texture of so many texels, log2, such that it is about as deep: from 0.35
/// to 2.8 times. 1 at least: 0 stands for a level that is the texture.
int foldOf(std::int64_t texels) {
    return std::max(1, int(std::lround(std::log2(double(texels)) / 3.0)));
}

} // namespace

std::int64_t SkipLayout::texelCount() const {
    return volumeOf(texels);
}

std::int64_t SkipLayout::bytes() const {
    return texelCount() * wordsPerTexel() * 4;
}

SkipLayout gridLayout(glm::ivec3 values, int bitsPerValue) {
    const int perTexel = bitsPerValue < 32 ? 32 / bitsPerValue : 1;
    const glm::ivec3 texels = texelsOf(values, perTexel);
    return {bitsPerValue, perTexel, texels, {{texels}}};
}

SkipLayout freeLengthLayout(glm::ivec3 blocks) {
    return gridLayout(blocks, 8);
}

SkipLayout octreeLayout(glm::ivec3 leaves, int levels, int bitsPerNode) {
    SLABCAST_EXPECTS(levels > 0 && levels <= kMaxOctreeLevels, levels);
    SkipLayout layout = gridLayout(leaves, bitsPerNode);
    layout.levels.clear();
    std::int64_t total = 0;
    for (int level = 0; level < levels; ++level) {
        const glm::ivec3 texels = texelsOf(blocksOf(leaves, 1 << level), layout.perTexel);
        layout.levels.push_back({texels, int(total)});
        total += volumeOf(texels);
    }
    const int fold = foldOf(total);
    for (SkipLevel& level : layout.levels) {
        level.fold = fold;
    }
    const std::int64_t perSlice = std::int64_t(1) << (2 * fold);
    layout.texels = glm::ivec3(1 << fold, 1 << fold, (total + perSlice - 1) / perSlice);
    return layout;
}

SkipLayout layoutOf(const Octree& octree) {
    return octreeLayout(octree.levels.front().nodes, int(octree.levels.size()), octree.bitsPerNode);
}

std::int64_t gpuBytes(const FreeLengths& lengths) {
    return freeLengthLayout(lengths.blocks).bytes();
}

std::int64_t gpuBytes(const Octree& octree) {
    return layoutOf(octree).bytes();
}

int slicesWithin(std::int64_t bytes, glm::ivec3 blocks) {
    const std::int64_t perSlice = freeLengthLayout({blocks.x, blocks.y, 1}).bytes();
    return int(std::clamp<std::int64_t>(bytes / perSlice, 1, blocks.z));
}

} // namespace slabcast

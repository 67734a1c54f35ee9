#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"

namespace slabcast {

/// Where a level of a structure lies in its texture. Texel (x, y, z) of the level is number
/// first + x + texels.x * (y + texels.y * z) of the texture's, counted along x, then y, then z.
struct SkipLevel {
    glm::ivec3 texels{1};
    int first = 0;
    /// log2 of the texture's width and height; 0: the level is the texture.
    int fold = 0;

    /// As shaders take it: first texel, texels of a row and of a slice, fold.
    glm::ivec4 address() const { return {first, texels.x, texels.x * texels.y, fold}; }

    bool operator==(const SkipLevel&) const = default;
};

/// How the values of a grid, or of a pyramid of grids, lie in a 3D texture. Values are packed along
/// x, low bits first: value (x, y, z) of a level lies in texel (x / perTexel, y, z), at the bit
/// x % perTexel * bits.
struct SkipLayout {
    int bits = 8;         // of a value
    int perTexel = 4;     // values; 1 from 32 bits on
    glm::ivec3 texels{1}; // of the texture
    std::vector<SkipLevel> levels;

    int wordsPerTexel() const { return bits <= 32 ? 1 : bits / 32; }
    std::int64_t texelCount() const;
    std::int64_t bytes() const;

    bool operator==(const SkipLayout&) const = default;
};

/// One level, which is the texture.
SkipLayout gridLayout(glm::ivec3 values, int bitsPerValue);

/// Bytes, four to a texel.
SkipLayout freeLengthLayout(glm::ivec3 blocks);

/// Levels one after the other, leaves first, as rows of whole texels, in a texture about as deep as
/// it is wide and high. Mip levels would not do: they round half the texels down where an octree
/// rounds half the nodes up. What is lost is the rest of the last slice: a tenth of what the levels
/// take and 119 texels at most. Contract: kMaxOctreeLevels at most. Tested by:
/// skip_texture_test.cpp
SkipLayout octreeLayout(glm::ivec3 leaves, int levels, int bitsPerNode);

/// Of any volume: 2^15 leaves along an edge.
constexpr int kMaxOctreeLevels = 16;

SkipLayout layoutOf(const Octree& octree);

/// Of the texture.
std::int64_t gpuBytes(const FreeLengths& lengths);
std::int64_t gpuBytes(const Octree& octree);

/// Slices of a grid's blocks along z whose texels are of so many bytes, one at least.
int slicesWithin(std::int64_t bytes, glm::ivec3 blocks);

} // namespace slabcast

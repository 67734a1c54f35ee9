#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "core/gl/caps.h"
#include "core/gl/objects.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/volume/volume_texture.h"

namespace slabcast {

/// A skip structure as shaders fetch it: one immutable 3D texture, unfiltered.
struct SkipTexture {
    gl::Texture texture;
    std::int64_t bytes = 0;
};

/// How values of a grid, or of a pyramid of grids, lie in a 3D texture. Values are packed along x,
/// low bits first: value (x, y, z) of a level lies in texel (x / perTexel, y, z), at the bit
/// x % perTexel * bits. Level k is mip k.
struct SkipLayout {
    int bits = 8;         // of a value
    int perTexel = 4;     // values; 1 from 32 bits on
    glm::ivec3 texels{1}; // of level 0; half as many along each axis with every level
    int levels = 1;

    glm::ivec3 texelsOf(int level) const { return texels >> level; }
    /// What lies beyond the structure within these is empty.
    glm::ivec3 valuesOf(int level) const { return texelsOf(level) * glm::ivec3(perTexel, 1, 1); }
    int wordsPerTexel() const { return bits <= 32 ? 1 : bits / 32; }
    std::int64_t bytes() const; // of all levels

    bool operator==(const SkipLayout&) const = default;
};

/// Bytes, four to a texel.
SkipLayout freeLengthLayout(glm::ivec3 blocks);

/// Leaves are padded to a multiple of 2^(levels-1) along each axis, and along x of as many times
/// perTexel: halving is exact.
SkipLayout octreeLayout(glm::ivec3 leaves, int levels, int bitsPerNode);

/// A node that nothing meets: no bits, or the range from 65535 to 0.
std::uint32_t emptyNode(NodeContent content);

/// R32UI up to 32 bits; RGBA16UI for 64, the lowest 16 bits in r; RGBA32UI for 128.
const TexelLayout& texelLayoutOf(const SkipLayout& layout);

std::int64_t gpuBytes(const FreeLengths& lengths);
std::int64_t gpuBytes(const Octree& octree);

/// Fails: VolumeTooLarge, where the device's 3D textures are too small, naming their limit.
/// Tested by: gpu_builder_gl_test.cpp
Result<void> checkFits(const SkipLayout& layout, const gl::Caps& caps);

/// Leave the GL state as they found it, and clear error flags that were up before. Fail:
/// VolumeTooLarge, DeviceOutOfMemory, Internal (another GL error). Tested by:
/// gpu_builder_gl_test.cpp
Result<SkipTexture> uploadFreeLengths(const FreeLengths& lengths, const gl::Caps& caps);
Result<SkipTexture> uploadOctree(const Octree& octree, const gl::Caps& caps);

} // namespace slabcast

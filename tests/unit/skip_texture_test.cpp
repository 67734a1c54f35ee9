#include "core/skip/gpu/skip_texture.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/skip/gpu/gpu_passes.h"
#include "core/skip/skip_structure.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyBool;
using test::anyElement;
using test::anyInt;

std::int64_t texelsOf(glm::ivec3 size) {
    return std::int64_t(size.x) * size.y * size.z;
}

/// A level's nodes as rows of whole texels: what it takes at least.
glm::ivec3 texelsOfLevel(glm::ivec3 leaves, int level, int bits) {
    const glm::ivec3 nodes = (leaves + (1 << level) - 1) >> level;
    const int perTexel = std::max(1, 32 / bits);
    return {(nodes.x + perTexel - 1) / perTexel, nodes.y, nodes.z};
}

struct Shape {
    glm::ivec3 leaves{1};
    int levels = 1;
    int bits = 32;
};

Shape randomShape(int mostLeaves) {
    const auto edge = [&] { return anyInt(1, mostLeaves); };
    Shape shape{{edge(), edge(), edge()}, 1, anyElement(8, 16, 32, 64, 128)};
    if (anyBool()) { // flat
        shape.leaves[anyInt(0, 3)] = anyInt(1, 4);
    }
    shape.levels = keptLevels(shape.leaves, anyInt(0, 3));
    return shape;
}

// A texture of t texels in all is 2^f wide and high with f within a half of log2(t) / 3. So its
// slices have 2 t^(2/3) texels at most, and less than one of them is lost; that is less than
// t / 10 + 118.6 for every t, the most where t^(1/3) is 40/3.
PROPERTY(OctreeLayout, TakesATenthMoreThanItsLevelsAtMost) {
    const Shape s = randomShape(400);
    const SkipLayout layout = octreeLayout(s.leaves, s.levels, s.bits);
    std::int64_t needed = 0;
    for (int level = 0; level < s.levels; ++level) {
        PROPERTY_ASSERT(layout.levels[level].texels == texelsOfLevel(s.leaves, level, s.bits));
        needed += texelsOf(layout.levels[level].texels);
    }
    const std::int64_t lost = texelsOf(layout.texels) - needed;
    PROPERTY_ASSERT(lost >= 0);
    PROPERTY_ASSERT(double(lost) < 0.1 * double(needed) + 119.0);
    const int bytesPerTexel = std::max(4, s.bits / 8);
    PROPERTY_ASSERT(layout.bytes() == texelsOf(layout.texels) * bytesPerTexel);
    PROPERTY_ASSERT(layout.texels.z <= 3 * layout.texels.x || layout.texels.x == 2);
}

/// As gles_shaders/build_levels.glsl.
glm::ivec3 placeOf(const SkipLevel& level, glm::ivec3 texel) {
    const glm::ivec4 a = level.address();
    const int number = a.x + texel.x + texel.y * a.y + texel.z * a.z;
    const int last = (1 << a.w) - 1;
    return {number & last, (number >> a.w) & last, number >> (2 * a.w)};
}

PROPERTY(OctreeLayout, GivesEveryTexelAPlaceOfItsOwn) {
    const Shape s = randomShape(18);
    const SkipLayout layout = octreeLayout(s.leaves, s.levels, s.bits);
    std::set<std::int64_t> taken;
    for (const SkipLevel& level : layout.levels) {
        for (std::int64_t i = 0; i < texelsOf(level.texels); ++i) {
            const glm::ivec3 texel(i % level.texels.x, i / level.texels.x % level.texels.y,
                                   i / level.texels.x / level.texels.y);
            const glm::ivec3 place = placeOf(level, texel);
            PROPERTY_ASSERT(glm::all(glm::lessThan(place, layout.texels)));
            PROPERTY_ASSERT(
                taken
                    .insert((std::int64_t(place.z) * layout.texels.y + place.y) * layout.texels.x +
                            place.x)
                    .second);
        }
    }
}

// Of 16-bit voxels at a leaf edge of 4 and 32 bits: (1/4^3) * 4 / 2 bytes of leaves are 3.1 %, all
// levels an eighth and so on more, 3.57 %.
TEST(OctreeLayout, TakesLessThanATwentiethOfTheVolume) {
    for (const glm::ivec3 dims : {glm::ivec3(256), glm::ivec3(260), glm::ivec3(257, 300, 131),
                                  glm::ivec3(512, 512, 40), glm::ivec3(256, 256, 108)}) {
        const glm::ivec3 leaves = blocksOf(dims, 4);
        const SkipLayout layout = octreeLayout(leaves, levelsToRoot(leaves), 32);
        EXPECT_LT(double(layout.bytes()) / (2.0 * double(texelsOf(dims))), 0.05) << dims.x;
    }
    const SkipLayout cube = octreeLayout(glm::ivec3(64), 7, 32);
    EXPECT_EQ(cube.levels.back().first, 299592);    // (8^7 - 1) / 7, less the root
    EXPECT_EQ(cube.texels, glm::ivec3(64, 64, 74)); // 299593 / 64^2, rounded up
}

TEST(OctreeLayout, IsRefusedBeyondTheDevicesTextures) {
    gl::Caps caps;
    caps.maxTexture3DSize = 74;
    const SkipLayout cube = octreeLayout(glm::ivec3(64), 7, 32);
    EXPECT_TRUE(checkFits(cube, caps).has_value());
    caps.maxTexture3DSize = 73;
    EXPECT_EQ(checkFits(cube, caps).error().code, ErrorCode::VolumeTooLarge);
    // 1300^3 leaves are more than 2^31 texels, none of them along an edge too far.
    caps.maxTexture3DSize = 16384;
    const Result<void> beyond = checkFits(octreeLayout(glm::ivec3(1300), 11, 32), caps);
    ASSERT_FALSE(beyond.has_value());
    EXPECT_NE(beyond.error().detail.find("shaders count to 2147483647"), std::string::npos);
    EXPECT_TRUE(checkFits(octreeLayout(glm::ivec3(1200), 11, 32), caps).has_value());
}

TEST(GridLayout, IsTheTextureItself) {
    const SkipLayout layout = freeLengthLayout({65, 33, 10});
    EXPECT_EQ(layout.texels, glm::ivec3(17, 33, 10));
    EXPECT_EQ(layout.bytes(), 17 * 33 * 10 * 4);
    ASSERT_EQ(layout.levels.size(), 1U);
    EXPECT_EQ(layout.levels.front(), (SkipLevel{layout.texels, 0, 0}));
}

/// What makes leaves declares as much shared memory as is asked for of a device: by its own text.
TEST(LeavesPass, TakesTheSharedMemoryThatItIsSaidTo) {
    const std::string text =
        passText(leavesPass(TexelCoding::Unorm8, NodeContent::Range, true, 4, 32)).value();
    EXPECT_NE(text.find("#define TILE_VOXELS 8\n"), std::string::npos);
    EXPECT_NE(text.find("#define THREADS 128\n"), std::string::npos);
    EXPECT_NE(text.find("const int kVoxels = kTile + 4;"), std::string::npos);
    EXPECT_NE(
        text.find("shared uint ranges[kBehind + (kVoxels - 1) * (kVoxels - 1) * (kVoxels - 1)];"),
        std::string::npos);
    EXPECT_EQ(leavesSharedBytes(), 4 * (12 * 12 * 12 + 11 * 11 * 11));
}

} // namespace
} // namespace slabcast

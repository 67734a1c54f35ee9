// Merges maps of partitions: the least distance to any partition of a set.
#include "build/precision.glsl"
#include "build/bytes.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(std430, binding = 1) readonly buffer Maps { uint maps[]; };
layout(r32ui, binding = 0) writeonly uniform uimage3D merged;
uniform ivec3 blocks;
uniform ivec3 texels;
uniform uvec4 partitionSet[2]; // bit p % 32 of component p / 32

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    int perMap = texels.x * texels.y * texels.z;
    int word = (at.z * texels.y + at.y) * texels.x + at.x;
    uvec4 least = uvec4(255u);
    for (int first = 0; first < 256; first += 32) {
        uint left = partitionSet[first >> 7][first >> 5 & 3];
        while (left != 0u) {
            int map = first + findLSB(left);
            least = min(least, bytesOf(maps[map * perMap + word]));
            left &= left - 1u;
        }
    }
    imageStore(merged, at, uvec4(withoutPadding(wordOf(least), at.x, blocks.x)));
}

// Max-norm distances, one axis more (AXIS 1 y, 2 z): the least over the blocks of the line of the
// larger of the way along it and the distance from there.
#include "build/precision.glsl"
#include "build/bytes.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D distances;
#if TO_BUFFER
layout(std430, binding = 1) writeonly buffer Maps { uint maps[]; };
uniform int firstWord;
#else
layout(r32ui, binding = 0) writeonly uniform uimage3D target;
#endif
uniform ivec3 blocks;
uniform ivec3 texels;

void write(ivec3 at, uint word) {
#if TO_BUFFER
    maps[firstWord + (at.z * texels.y + at.y) * texels.x + at.x] = word;
#else
    imageStore(target, at, uvec4(word));
#endif
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    const ivec3 kStep = ivec3(0, AXIS == 1, AXIS == 2);
    int before = AXIS == 1 ? at.y : at.z % blocks.z; // blocks on this side of the line
    int after = blocks[AXIS] - 1 - before;
    uvec4 least = bytesOf(texelFetch(distances, at, 0).r);
    for (int way = 1; way <= max(before, after); ++way) {
        if (all(lessThanEqual(least, uvec4(way)))) {
            break; // all that is left is as far
        }
        if (way <= before) {
            uvec4 there = bytesOf(texelFetch(distances, at - way * kStep, 0).r);
            least = min(least, max(there, uvec4(way)));
        }
        if (way <= after) {
            uvec4 there = bytesOf(texelFetch(distances, at + way * kStep, 0).r);
            least = min(least, max(there, uvec4(way)));
        }
    }
    write(at, withoutPadding(wordOf(least), at.x, blocks.x));
}

// Free lengths from squared lengths in the xy plane: the last axis, then the root, as a count.
#include "build/precision.glsl"
#include "build/bytes.glsl"
#include "build/squares.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D squares;
layout(binding = 1) uniform usampler2D countStarts; // least square of every count but 0
layout(binding = 2) uniform usampler3D alongX;
layout(std430, binding = 0) readonly buffer Found { uint anyOccupied; };
layout(r32ui, binding = 0) writeonly uniform uimage3D counts;
uniform ivec3 blocks;
uniform ivec3 texels;
uniform ivec3 unitsPerBlock;
uniform int firstRow;

uvec4 squaresAt(ivec3 at) {
    return texelFetch(squares, at, 0);
}

/// The largest count whose least square is no more than this one.
uint countOf(uint square) {
    int count = 1;
    for (int step = 128; step > 0; step >>= 1) {
        if (count + step < 256 && texelFetch(countStarts, ivec2(count + step, 0), 0).r <= square) {
            count += step;
        }
    }
    return uint(count);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    ivec3 block = at + ivec3(0, firstRow, 0);
    uvec4 least =
        leastAlongLine(at, ivec3(0, 0, 1), at.z, blocks.z - 1 - at.z, unitsPerBlock.z);
    uvec4 count = uvec4(countOf(least.x), countOf(least.y), countOf(least.z), countOf(least.w));
    uvec4 occupied = uvec4(equal(bytesOf(texelFetch(alongX, block, 0).r), uvec4(0u)));
    count = anyOccupied == 0u ? uvec4(255u) : count * (1u - occupied);
    imageStore(counts, block, uvec4(withoutPadding(wordOf(count), at.x, blocks.x)));
}

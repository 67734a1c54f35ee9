// Squared lengths in the xy plane, from distances along x: rows [firstRow, firstRow + texels.y).
#include "build/precision.glsl"
#include "build/bytes.glsl"
#include "build/squares.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D alongX; // blocks to the closest occupied one of the row
layout(rgba32ui, binding = 0) writeonly uniform uimage3D squares;
uniform ivec3 blocks;
uniform ivec3 texels;
uniform ivec3 unitsPerBlock;
uniform int firstRow;

uvec4 squaresAt(ivec3 at) {
    ivec4 gap = max(ivec4(bytesOf(texelFetch(alongX, at, 0).r)) - 1, 0);
    return uvec4(squaredGap(gap.x, unitsPerBlock.x), squaredGap(gap.y, unitsPerBlock.x),
                 squaredGap(gap.z, unitsPerBlock.x), squaredGap(gap.w, unitsPerBlock.x));
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    int row = firstRow + at.y;
    uvec4 least = leastAlongLine(ivec3(at.x, row, at.z), ivec3(0, 1, 0), row, blocks.y - 1 - row,
                                 unitsPerBlock.y);
    imageStore(squares, at, least);
}

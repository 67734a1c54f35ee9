// Distance along x to the closest occupied block of the same row, in blocks, at most 255. Occupied
// is what is marked, or OF_PARTITION what has a partition in its range of bins; then the grids of
// several partitions lie above each other in z.
#include "build/precision.glsl"
#include "build/bytes.glsl"
#include "build/range.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D blockData;
layout(r32ui, binding = 0) writeonly uniform uimage3D distances;
uniform ivec3 blocks;
uniform ivec3 texels;
uniform int firstPartition;

/// Bit i: block i of the texel is occupied.
uint occupiedFour(ivec3 at) {
#if OF_PARTITION
    uint bin = uint(firstPartition + at.z / blocks.z);
    uint bits = 0u;
    for (int i = 0; i < 4 && at.x * 4 + i < blocks.x; ++i) {
        uint range = texelFetch(blockData, ivec3(at.x * 4 + i, at.y, at.z % blocks.z), 0).r;
        bool within = leastOf(range) <= bin && bin <= greatestOf(range);
        bits |= uint(within) << i;
    }
    return bits;
#else
    uvec4 marked = bytesOf(texelFetch(blockData, at, 0).r) << uvec4(0, 1, 2, 3);
    return marked.x | marked.y | marked.z | marked.w;
#endif
}

const int kNone = 1 << 16; // farther than any distance
const int kTexelsInReach = 64;

int closestBefore(ivec3 at) {
    for (int x = at.x - 1; x >= max(at.x - kTexelsInReach, 0); --x) {
        uint bits = occupiedFour(ivec3(x, at.yz));
        if (bits != 0u) {
            return 4 * x + findMSB(bits);
        }
    }
    return -kNone;
}

int closestAfter(ivec3 at) {
    for (int x = at.x + 1; x < min(at.x + kTexelsInReach + 1, texels.x); ++x) {
        uint bits = occupiedFour(ivec3(x, at.yz));
        if (bits != 0u) {
            return 4 * x + findLSB(bits);
        }
    }
    return kNone;
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    ivec4 block = 4 * at.x + ivec4(0, 1, 2, 3);
    ivec4 nearest = min(block - closestBefore(at), closestAfter(at) - block);
    uint here = occupiedFour(at);
    for (int i = 0; i < 4; ++i) {
        if ((here >> i & 1u) != 0u) {
            nearest = min(nearest, abs(block - block[i]));
        }
    }
    imageStore(distances, at, uvec4(wordOf(uvec4(min(nearest, 255)))));
}

// Leaves of octrees, and blocks: what of the volume's values meets each grown by one voxel. A
// workgroup looks at tiles of 8^3 voxels with their margin, one after the other along x where a
// texel holds the nodes of several. See core/skip/occupancy.h and octree.h.
#include "build/precision.glsl"
#include "build/nodes.glsl"
#include "build/levels.glsl"
#include CODE_FILE
layout(local_size_x = THREADS) in;
#if !OF_CODES
layout(binding = 1) uniform usampler2D rangeOfCode; // 256 wide
#endif
layout(NODE_FORMAT, binding = 0) writeonly uniform uimage3D nodes;
#if OCCUPIED
layout(std430, binding = 0) writeonly buffer Found { uint anyOccupied; };
#endif
uniform ivec3 dims;
uniform ivec3 leaves;
uniform ivec3 texels;
uniform ivec4 address;

// Voxels along each edge of a tile: the longest leaf that one makes.
const int kTile = TILE_VOXELS;
const int kLeaves = kTile / EDGE;            // the same in leaves
const int kPerTile = min(kLeaves, kPerTexel); // nodes that a tile gives to a texel
const int kTiles = kPerTexel / kPerTile;
const ivec3 kTexels = ivec3(kLeaves / kPerTile, kLeaves, kLeaves); // that a workgroup writes

// A tile's voxels, two before it and two after it; what they fold to lies in turn behind them and
// in their place.
const int kVoxels = kTile + 4;
const int kBehind = kVoxels * kVoxels * kVoxels;
// What meets a leaf grown by a voxel: so many cells, whose corners are one voxel more.
#if OCCUPIED
const int kSide = kVoxels - 1;
const int kWindow = EDGE + 3;
const int kFrom = kBehind;
#else
const int kSide = kVoxels;
const int kWindow = EDGE + 4;
const int kFrom = 0;
#endif
const int kTo = kBehind - kFrom;
shared uint ranges[kBehind + (kVoxels - 1) * (kVoxels - 1) * (kVoxels - 1)];

ivec3 position(int index, int side, int rows) {
    return ivec3(index % side, index / side % rows, index / (side * rows));
}

uint rangeAt(ivec3 voxel) {
    uint code = codeAt(clamp(voxel, ivec3(0), dims - 1));
#if OF_CODES
    return code | code << 16;
#else
    return texelFetch(rangeOfCode, ivec2(code & 255u, code >> 8), 0).r;
#endif
}

void loadVoxels(ivec3 tile) {
    for (int i = int(gl_LocalInvocationIndex); i < kBehind; i += THREADS) {
        ranges[i] = rangeAt(tile * kTile - 2 + position(i, kVoxels, kVoxels));
    }
    barrier();
}

/// Marks the cells that are visible: whose first visible table texel is within reach.
void makeCells() {
    for (int i = int(gl_LocalInvocationIndex); i < kSide * kSide * kSide; i += THREADS) {
        ivec3 cell = position(i, kSide, kSide);
        int at = (cell.z * kVoxels + cell.y) * kVoxels + cell.x;
        uint range = kNoRange;
        for (int corner = 0; corner < 8; ++corner) {
            int row = (corner >> 2) * kVoxels + (corner >> 1 & 1);
            range = joined(range, ranges[at + row * kVoxels + (corner & 1)]);
        }
        ranges[kBehind + i] = leastOf(range) <= greatestOf(range) ? 1u << 16 : 0u;
    }
    barrier();
}

uint folded(int first, int stride) {
    uint range = ranges[first];
    for (int k = 1; k < kWindow; ++k) {
        range = joined(range, ranges[first + k * stride]);
    }
    return range;
}

void foldAlongX() {
    for (int i = int(gl_LocalInvocationIndex); i < kLeaves * kSide * kSide; i += THREADS) {
        ranges[kTo + i] = folded(kFrom + i / kLeaves * kSide + i % kLeaves * EDGE, 1);
    }
    barrier();
}

void foldAlongY() {
    for (int i = int(gl_LocalInvocationIndex); i < kLeaves * kLeaves * kSide; i += THREADS) {
        ivec3 at = position(i, kLeaves, kLeaves);
        int first = (at.z * kSide + at.y * EDGE) * kLeaves + at.x;
        ranges[kFrom + i] = folded(kTo + first, kLeaves);
    }
    barrier();
}

uvec4 nodeAt(ivec3 inTile) {
    const int kStride = kLeaves * kLeaves;
    int first = inTile.z * EDGE * kStride + inTile.y * kLeaves + inTile.x;
    return nodeOf(folded(kFrom + first, kStride));
}

void main() {
    ivec3 group = ivec3(gl_WorkGroupID);
    uvec4 texel;
    for (int t = 0; t < kTiles; ++t) {
        ivec3 tile = ivec3(group.x * kTiles + t, group.yz);
        bool inside = all(lessThan(tile * kTile, dims));
        if (inside) {
            barrier(); // the tile before is read
            loadVoxels(tile);
#if OCCUPIED
            makeCells();
#endif
            foldAlongX();
            foldAlongY();
        }
        for (int i = int(gl_LocalInvocationIndex); i < kTexels.x * kTexels.y * kTexels.z;
             i += THREADS) {
            ivec3 at = position(i, kTexels.x, kTexels.y);
            texel = t == 0 ? uvec4(0) : texel;
            for (int n = 0; n < kPerTile; ++n) {
                ivec3 inTile = ivec3(at.x * kPerTile + n, at.yz);
                bool exists = inside && all(lessThan(tile * kLeaves + inTile, leaves));
                uvec4 node = exists ? nodeAt(inTile) : emptyNode();
                texel |= node << (uint(t * kPerTile + n) * uint(BITS & 31));
            }
            ivec3 place = group * kTexels + at;
            if (t == kTiles - 1 && all(lessThan(place, texels))) {
                imageStore(nodes, texelOfLevel(place, address), texel);
#if OCCUPIED
                if (texel.x != 0u) {
                    anyOccupied = 1u;
                }
#endif
            }
        }
    }
}

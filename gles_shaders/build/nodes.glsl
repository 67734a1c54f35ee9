// What a node holds, by CONTENT: 0 a mark, 1 the bins of a range, 2 the range itself; and how nodes
// of BITS lie in a texel. See core/skip/octree.h and skip_texture.h.
#include "build/range.glsl"
#define OCCUPIED (CONTENT == 0)
#define BINS (CONTENT == 1)

const int kPerTexel = BITS < 32 ? 32 / BITS : 1;
const int kBinsPerComponent = BITS == 64 ? 16 : 32; // of a texel of wide nodes

/// Bits below `end`.
uvec4 bitsBelow(ivec4 end) {
    ivec4 count = clamp(end, 0, 32);
    return mix((uvec4(1u) << uvec4(count & 31)) - 1u, uvec4(~0u), equal(count, ivec4(32)));
}

uvec4 nodeOf(uint range) {
#if OCCUPIED
    return uvec4(greatestOf(range), 0, 0, 0);
#elif BINS
    ivec4 first = ivec4(0, 1, 2, 3) * kBinsPerComponent;
    uvec4 bins = bitsBelow(int(greatestOf(range)) + 1 - first);
    bins &= ~bitsBelow(int(leastOf(range)) - first);
    return BITS == 64 ? bins & 0xffffu : BITS == 128 ? bins : uvec4(bins.x, 0, 0, 0);
#else
    return uvec4(range, 0, 0, 0);
#endif
}

uvec4 emptyNode() {
    return uvec4(OCCUPIED || BINS ? 0u : kNoRange, 0, 0, 0);
}

uvec4 joinedNodes(uvec4 a, uvec4 b) {
#if OCCUPIED || BINS
    return a | b;
#else
    return uvec4(joined(a.x, b.x), 0, 0, 0);
#endif
}

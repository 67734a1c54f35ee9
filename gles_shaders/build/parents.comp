// A level of an octree from the one below: a node holds what its eight children hold. An invocation
// writes a texel. Beyond the last children there is nothing.
#include "build/precision.glsl"
#include "build/nodes.glsl"
#include "build/levels.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D children;
layout(NODE_FORMAT, binding = 0) writeonly uniform uimage3D nodes;
uniform ivec3 texels;
uniform ivec4 address;
uniform ivec3 childTexels;
uniform ivec4 childAddress;

uvec4 childAt(ivec3 at) {
    return all(lessThan(at, childTexels))
               ? texelFetch(children, texelOfLevel(at, childAddress), 0)
               : emptyNode(); // narrow nodes, of which a texel holds several, are empty as zeros
}

/// Four texels of children side by side in y and z.
uvec4 joinedColumn(ivec3 first) {
    uvec4 node = childAt(first);
    for (int i = 1; i < 4; ++i) {
        node = joinedNodes(node, childAt(first + ivec3(0, i & 1, i >> 1)));
    }
    return node;
}

/// Joins the texel's narrow nodes in pairs, into its lower half.
uint joinedPairs(uint word) {
#if BITS == 8
    uint pairs = (word | word >> 8) & 0x00ff00ffu;
    return (pairs | pairs >> 8) & 0xffffu;
#else
    return (word | word >> 16) & 0xffffu;
#endif
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    uvec4 left = joinedColumn(2 * at);
    uvec4 right = joinedColumn(2 * at + ivec3(1, 0, 0));
    uvec4 node = kPerTexel == 1
                     ? joinedNodes(left, right)
                     : uvec4(joinedPairs(left.x) | joinedPairs(right.x) << 16, 0, 0, 0);
    imageStore(nodes, texelOfLevel(at, address), node);
}

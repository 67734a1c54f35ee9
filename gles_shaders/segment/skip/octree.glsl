// Octrees (Faludi et al. 2021). A look tests the smallest node that holds the first and the last
// sample of a group. Levels count from the leaves. See core/skip/octree.h.
#include "segment/skip/faces.glsl"
#include "segment/skip/levels.glsl"
uniform usampler3D skipTexels;

/// The texel that holds a node, or is one.
uvec4 texelOfNode(ivec3 node, int level) {
    countSkipFetch();
    ivec3 last = skipBlocks.xyz >> level; // node
    int texelsPerRow = (last.x >> octree.y) + 1;
    int row = node.z * (last.y + 1) + node.y;
    int number = octreeLevels[level].x + row * texelsPerRow + (node.x >> octree.y);
    return texelFetch(skipTexels, foldedTexel(number, octree.z), 0);
}
#include NODE_FILE

/// Level of the smallest node that holds two leaves.
int levelOfBoth(ivec3 a, ivec3 b) {
    ivec3 differ = a ^ b;
    return findMSB(differ.x | differ.y | differ.z) + 1;
}

bool isFree(Ray ray, Segment segment, float first, float last) {
    ivec3 leaf = ivec3(blocksAt(ray, segment, first));
    int level = levelOfBoth(leaf, ivec3(blocksAt(ray, segment, last)));
    bool found = level <= octree.x && nodeIsFree(leaf, level);
    countLook(found);
    return found;
}

#include OCTREE_WALK_FILE

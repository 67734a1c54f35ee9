// Octrees (Faludi et al. 2021). One look tests one node, so that neighbouring fragments stay
// together and a written-out segment has no loop: a free node is left at its face, a leaf that is
// not free is marched through, and anything else says to look again one level down. Levels count
// from the leaves. See core/skip/octree.h.
#include "segment/skip/box.glsl"
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

const int kCoarsest = 31;  // beyond any tree
int nextLevel = kCoarsest; // of the next look

/// The smallest node that holds both ends proves all of the segment empty.
bool segmentIsEmpty(Ray ray, ivec2 range) {
    int last = range.y - 1 + kSharedEnds; // sample
    ivec3 a = blockAt(samplePosition(ray, range.x) * skipMap.xyz);
    ivec3 b = blockAt(samplePosition(ray, last) * skipMap.xyz);
    ivec3 differ = a ^ b;
    int level = findMSB(differ.x | differ.y | differ.z) + 1;
    return level <= octree.x && nodeIsFree(a, level);
}

Stretch stretchAt(vec3 uvw, Ray ray) {
    vec3 position = uvw * skipMap.xyz;
    ivec3 leaf = blockAt(position);
    int level = min(nextLevel, octree.x);
    bool isFree = nodeIsFree(leaf, level);
    if (!isFree && level > 0) {
        nextLevel = level - 1;
        return Stretch(0, true);
    }
    nextLevel = isFree ? level + octreeRise : octreeRise - 1;
    ivec3 first = (leaf >> level) << level;
    Box node = Box(vec3(first), vec3(first + (1 << level)));
    return stretchOf(samplesInBox(node, position, ray), isFree);
}

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

int nextLevel = 0; // of the next look, at least

/// A loop may go on to the nodes around that one: it begins above and goes down.
float freeThrough(Ray ray, Segment segment, float first, float last) {
    vec3 place = blocksAt(ray, segment, first);
    ivec3 leaf = ivec3(place);
    int least = levelOfBoth(leaf, ivec3(blocksAt(ray, segment, last)));
    int level = max(least, min(nextLevel, octree.x));
    bool found = false;
    while (!found && level >= least && level <= octree.x) {
        found = nodeIsFree(leaf, level);
        level -= found ? 0 : 1;
    }
    nextLevel = found ? level + octreeRise : octreeRise - 1;
    vec3 halfEdge = vec3(float(1 << level) * 0.5);
    vec3 centre = vec3((leaf >> level) << level) + halfEdge;
    return freeWhere(found, first + layersAhead(ray, place, centre, halfEdge));
}

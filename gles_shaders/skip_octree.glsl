// Octrees (Faludi et al. 2021). One look tests one node, so that neighbouring fragments stay
// together and a written-out segment has no loop: a free node is left at its face, a leaf that is
// not free is marched through, and anything else says to look again one level down. One mip level
// per level of the tree, leaves first. See core/skip/octree.h.
#include "skip_box.glsl"
uniform usampler3D skipTexels;
#include NODE_FILE

const int kCoarsest = 31; // beyond any tree
int nextMip = kCoarsest;  // level of the next look

/// The smallest node that holds both ends proves all of the segment empty.
bool segmentIsEmpty(Ray ray, ivec2 range) {
    int last = range.y - 1 + kSharedEnds; // sample
    ivec3 a = blockAt(samplePosition(ray, range.x) * skipMap.xyz);
    ivec3 b = blockAt(samplePosition(ray, last) * skipMap.xyz);
    ivec3 differ = a ^ b;
    int mip = findMSB(differ.x | differ.y | differ.z) + 1;
    return mip <= octree.x && nodeIsFree(a, mip);
}

Stretch stretchAt(vec3 uvw, Ray ray) {
    vec3 position = uvw * skipMap.xyz;
    ivec3 leaf = blockAt(position);
    int mip = min(nextMip, octree.x);
    bool isFree = nodeIsFree(leaf, mip);
    if (!isFree && mip > 0) {
        nextMip = mip - 1;
        return Stretch(0, true);
    }
    nextMip = isFree ? mip + octreeRise : octreeRise - 1;
    ivec3 first = (leaf >> mip) << mip;
    Box node = Box(vec3(first), vec3(first + (1 << mip)));
    return stretchOf(samplesInBox(node, position, ray), isFree);
}

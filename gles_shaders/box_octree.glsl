// Octrees (Faludi et al. 2021): the largest free node found at a place, or its leaf. One mip level
// per level of the tree, leaves first. See core/skip/octree.h.
uniform usampler3D skipTexels;
#include NODE_FILE

const int kMostLevels = 12;
#include WALK_FILE

Box boxAt(vec3 position) {
    ivec3 leaf = clamp(ivec3(floor(position)), ivec3(0), skipBlocks.xyz);
    int mip;
    bool isFree = walkToNode(leaf, mip);
    ivec3 first = (leaf >> mip) << mip;
    return Box(vec3(first), vec3(first + (1 << mip)), isFree);
}

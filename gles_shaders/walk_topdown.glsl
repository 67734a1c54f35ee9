// Every test begins at the initial level.
bool walkToNode(ivec3 leaf, out int mip) {
    mip = octree.x;
    bool isFree = nodeIsFree(leaf, mip);
    for (int k = 0; k < kMostLevels; ++k) {
        if (isFree || mip == 0) {
            break;
        }
        --mip;
        isFree = nodeIsFree(leaf, mip);
    }
    return isFree;
}

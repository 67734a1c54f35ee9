// Goes on at the level of the last test: up while the nodes stay free, else down to one that is.
int lastMip = kMostLevels;

bool walkToNode(ivec3 leaf, out int mip) {
    mip = min(lastMip, octree.x);
    bool isFree = nodeIsFree(leaf, mip);
    if (isFree) {
        for (int k = 0; k < kMostLevels; ++k) {
            if (mip == octree.x || !nodeIsFree(leaf, mip + 1)) {
                break;
            }
            ++mip;
        }
    } else {
        for (int k = 0; k < kMostLevels; ++k) {
            if (isFree || mip == 0) {
                break;
            }
            --mip;
            isFree = nodeIsFree(leaf, mip);
        }
    }
    lastMip = mip;
    return isFree;
}

// Nodes of two codes, least in the low half and greatest in the high one: free outside of the
// transfer function's range.
bool nodeIsFree(ivec3 leaf, int level) {
    uint range = texelOfNode(leaf >> level, level).r;
    return (range & 65535u) > nodeTest.y || (range >> 16) < nodeTest.x;
}

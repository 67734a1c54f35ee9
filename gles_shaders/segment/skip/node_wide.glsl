// Nodes of 64 or 128 bits: four components of 16 or 32.
bool nodeIsFree(ivec3 leaf, int level) {
    return (texelOfNode(leaf >> level, level) & nodeTest) == uvec4(0u);
}

// Nodes of 8, 16 or 32 bits, four, two or one to a texel.
bool nodeIsFree(ivec3 leaf, int level) {
    ivec3 node = leaf >> level;
    int place = node.x & (1 << octree.y) - 1; // in its texel
    uint word = texelOfNode(node, level).r >> uint(place * octree.w);
    return (word & nodeTest.x) == 0u;
}

// Nodes of 8, 16 or 32 bits, one, two or four to a texel.
bool nodeIsFree(ivec3 leaf, int mip) {
    countSkipFetch();
    ivec3 node = leaf >> mip;
    uint texel = texelFetch(skipTexels, ivec3(node.x >> octree.y, node.yz), mip).r;
    uint word = texel >> uint((node.x & octree.z) * octree.w);
    return (word & nodeTest.x) == 0u;
}

// Nodes of 64 or 128 bits: four components of 16 or 32.
bool nodeIsFree(ivec3 leaf, int mip) {
    countSkipFetch();
    uvec4 texel = texelFetch(skipTexels, leaf >> mip, mip);
    return (texel & nodeTest) == uvec4(0u);
}

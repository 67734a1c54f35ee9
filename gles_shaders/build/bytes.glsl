// Four blocks' bytes to a word, the first one low.
uvec4 bytesOf(uint word) {
    return uvec4(word) >> uvec4(0u, 8u, 16u, 24u) & 255u;
}

uint wordOf(uvec4 bytes) {
    uvec4 placed = bytes << uvec4(0u, 8u, 16u, 24u);
    return placed.x | placed.y | placed.z | placed.w;
}

/// Zeros for those of the word's blocks that lie beyond the last one.
uint withoutPadding(uint word, int texel, int blocks) {
    int beyond = max(4 * (texel + 1) - blocks, 0);
    return word & ~0u >> uint(8 * beyond);
}

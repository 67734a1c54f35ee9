// A byte per block, four to a texel. See core/skip/free_lengths.h and skip_texture.h.
uniform usampler3D skipTexels;

uint fourCounts(ivec3 block) {
    countSkipFetch();
    return texelFetch(skipTexels, ivec3(block.x >> 2, block.yz), 0).r;
}

int freeCount(ivec3 block) {
    return int(fourCounts(block) >> uint((block.x & 3) * 8) & 255u);
}

/// Whether a block's count is above another. Its byte is moved to the top and compared with what is
/// below it set: no mask, and no conversion to wait for.
bool countIsAbove(ivec3 block, uint other) {
    bool above = fourCounts(block) << uint((~block.x & 3) * 8) > (other << 24 | 0xffffffu);
    countLook(above);
    return above;
}

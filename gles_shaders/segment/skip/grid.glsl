// A byte per block, four to a texel. See core/skip/free_lengths.h and skip_texture.h.
uniform usampler3D skipTexels;

int freeCount(ivec3 block) {
    countSkipFetch();
    uint four = texelFetch(skipTexels, ivec3(block.x >> 2, block.yz), 0).r;
    return int(four >> uint((block.x & 3) * 8) & 255u);
}

// Codes of halfs: their bits in the order of their values.
layout(binding = 0) uniform sampler3D voxels;

uint codeAt(ivec3 voxel) {
    uint bits = packHalf2x16(vec2(texelFetch(voxels, voxel, 0).r, 0.0)) & 0xffffu;
    return (bits & 0x8000u) != 0u ? ~bits & 0xffffu : bits | 0x8000u;
}

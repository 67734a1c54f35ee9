// Codes of 16-bit integers as high and low byte.
layout(binding = 0) uniform sampler3D voxels;

uint codeAt(ivec3 voxel) {
    uvec2 bytes = uvec2(texelFetch(voxels, voxel, 0).rg * 255.0 + 0.5);
    return bytes.r << 8 | bytes.g;
}

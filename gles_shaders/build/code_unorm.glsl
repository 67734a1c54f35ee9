// Codes of normalised texels: what is stored. CODE_CHANNEL is r, or the a of pre-classified texels.
layout(binding = 0) uniform sampler3D voxels;

uint codeAt(ivec3 voxel) {
    return uint(texelFetch(voxels, voxel, 0).CODE_CHANNEL * CODE_MOST + 0.5);
}

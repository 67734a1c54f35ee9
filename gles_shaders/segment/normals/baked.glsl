// The gradient of the voxels, baked beforehand (core/volume/normals.h) and filtered by the texture
// unit: its direction in patient space, its steepness as a root.
uniform sampler3D normalTexels;

vec4 gradientAt(vec3 uvw) {
    vec4 texel = textureLod(normalTexels, uvw, 0.0);
    countFetches(1);
    return vec4(texel.xyz, texel.w * texel.w * gradientRow[0].w);
}

// The scalar field from eight fetches, interpolated in float32: no filter's weights, every voxel as it is stored.
uniform sampler3D volumeTexels;
const int kFetchesPerSample = 8;

float voxelAt(ivec3 voxel) {
    return dot(texelFetch(volumeTexels, voxel, 0).rg, decode.xy);
}

vec3 fieldSize() {
    return vec3(textureSize(volumeTexels, 0));
}

float sampleField(vec3 uvw) {
    vec3 size = fieldSize();
    vec3 at = clamp(uvw * size - 0.5, vec3(0.0), size - 1.0);
    ivec3 low = ivec3(at);
    ivec3 high = min(low + 1, ivec3(size) - 1);
    vec3 f = at - vec3(low);
    vec2 y0 = vec2(mix(voxelAt(low), voxelAt(ivec3(high.x, low.y, low.z)), f.x),
                   mix(voxelAt(ivec3(low.x, high.y, low.z)), voxelAt(ivec3(high.x, high.y, low.z)), f.x));
    vec2 y1 = vec2(mix(voxelAt(ivec3(low.x, low.y, high.z)), voxelAt(ivec3(high.x, low.y, high.z)), f.x),
                   mix(voxelAt(ivec3(low.x, high.y, high.z)), voxelAt(high), f.x));
    return mix(mix(y0.x, y0.y, f.y), mix(y1.x, y1.y, f.y), f.z);
}

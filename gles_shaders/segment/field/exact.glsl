// The scalar field from eight fetches, interpolated in float32: no filter's weights, every voxel as
// it is stored.
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
    // In x for the four edges (y, z) = 00 10 01 11, then y for two, then z.
    vec4 left = vec4(voxelAt(low), voxelAt(ivec3(low.x, high.y, low.z)),
                     voxelAt(ivec3(low.x, low.y, high.z)), voxelAt(ivec3(low.x, high.yz)));
    vec4 right = vec4(voxelAt(ivec3(high.x, low.yz)), voxelAt(ivec3(high.xy, low.z)),
                      voxelAt(ivec3(high.x, low.y, high.z)), voxelAt(high));
    // Not mix(), which may turn two equal values into a third.
    precise vec4 x = left + (right - left) * f.x;
    precise vec2 y = x.xz + (x.yw - x.xz) * f.y;
    precise float z = y.x + (y.y - y.x) * f.z;
    return z;
}

// The scalar field by the texture unit's own filter.
uniform sampler3D volumeTexels;
const int kFetchesPerSample = 1;

float sampleField(vec3 uvw) {
    return textureLod(volumeTexels, uvw, 0.0).r;
}

vec3 fieldSize() {
    return vec3(textureSize(volumeTexels, 0));
}

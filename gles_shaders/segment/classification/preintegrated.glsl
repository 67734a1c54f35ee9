// Pre-integrated classification: a layer is the interval between two samples, along which the field
// is taken to run linearly. L layers take L + 1 samples. See core/transfer/preintegrated.h.
#include FIELD_FILE
#include "segment/classification/one_material.glsl"
#include MATERIAL_OF_INTERVAL_FILE
const float kSampleAt = 0.0; // of a layer: its front
const int kSharedEnds = 1;   // samples that neighbouring layers have in common

/// Where the front of layer k, or the end of the stay, lies along an axis of the table; beyond its
/// ends too.
float texelAt(Ray ray, Segment segment, float k) {
    countFetches(kFetchesPerSample);
    vec3 uvw = placeOf(ray, segment, kept(segment, k));
    precise float at = (sampleField(uvw) - tableMap.y) * tableMap.x;
    return clamp(at, -1.0e18, 1.0e18);
}

float frontOf(Ray ray, Segment segment, float k) {
    return texelAt(ray, segment, k);
}

vec4 layerAt(Ray ray, Segment segment, float k, inout float front) {
    float back = texelAt(ray, segment, k + 1.0);
    vec4 mean = meanBetween(front, back, kLabel, kSide);
    front = back;
    return mean;
}

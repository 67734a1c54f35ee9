// Post-classification: a layer is what the material makes of the interpolated value.
#include FIELD_FILE
#include "segment/classification/sample_middle.glsl"
#include "segment/classification/one_material.glsl"
#include SHADING_FILE
#include MATERIAL_OF_VALUE_FILE
float fullLight(vec4 found);

vec4 layerAt(Ray ray, Segment segment, float k, inout float front) {
    vec3 uvw = middleOf(ray, segment, k);
    countFetches(kFetchesPerSample);
    vec4 found = materialOf(sampleField(uvw), kLabel, kSide);
    return vec4(shade(found.rgb, fullLight(found), uvw, ray), found.a);
}

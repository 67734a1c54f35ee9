// Post-classification: a layer is what the material makes of the interpolated value.
#include FIELD_FILE
#include "segment/classification/sample_middle.glsl"
#include "segment/classification/one_material.glsl"
#include SHADING_FILE
#include MATERIAL_OF_VALUE_FILE

/// Premultiplied colour and opacity of layer i, whose sample lies at uvw.
vec4 classify(vec3 uvw, Ray ray, int i) {
    float value = sampleField(uvw);
    countFetches(kFetchesPerSample);
    vec4 found = materialOf(value, kLabel, kSide);
    float alpha = opacityOfDepth(found.a * (lengthInside(ray, i) * tableMap.z));
    if (alpha == 0.0) {
        return vec4(0.0);
    }
    return vec4(inColour(shade(found.rgb, uvw, ray) * alpha), alpha);
}

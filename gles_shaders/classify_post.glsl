// Post-classification: the interpolated value is looked up in the TF's table.
#include FIELD_FILE
#include SHADE_FILE
precision highp sampler2D;
uniform sampler2D transferTable;

/// Premultiplied colour and opacity of `lengthMm` of what lies at uvw.
vec4 classify(vec3 uvw, float lengthMm, Ray ray) {
    float value = sampleField(uvw);
    countFetches(kFetchesPerSample);
    vec4 material = textureLod(transferTable, vec2(value * tableMap.x + tableMap.y, 0.5), 0.0);
    float alpha = opacityOfDepth(material.a * lengthMm);
    if (alpha == 0.0) {
        return vec4(0.0);
    }
    return vec4(shade(material.rgb, uvw, ray) * alpha, alpha);
}

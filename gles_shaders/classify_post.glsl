// Post-classification: the interpolated value is looked up in the TF's table.
#include FIELD_FILE
#include SHADE_FILE
precision highp sampler2D;
uniform sampler2D transferTable;

/// Two fetches and a float32 interpolation: texture units may filter with 8-bit weights, and what
/// is zero in both texels must be exactly zero between them.
vec4 materialOf(float value) {
    precise float at = clamp((value - tableMap.y) * tableMap.x, 0.0, tableMap.w);
    int texel = int(at);
    vec4 low = texelFetch(transferTable, ivec2(texel, 0), 0);
    vec4 high = texelFetch(transferTable, ivec2(min(texel + 1, int(tableMap.w)), 0), 0);
    precise vec4 material = low + (high - low) * (at - float(texel));
    return material;
}

/// Premultiplied colour and opacity of `lengthMm` of what lies at uvw.
vec4 classify(vec3 uvw, float lengthMm, Ray ray) {
    float value = sampleField(uvw);
    countFetches(kFetchesPerSample);
    vec4 material = materialOf(value);
    float alpha = opacityOfDepth(material.a * (lengthMm * tableMap.z));
    if (alpha == 0.0) {
        return vec4(0.0);
    }
    return vec4(shade(material.rgb, uvw, ray) * alpha, alpha);
}

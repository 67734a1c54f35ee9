// Pre-classification, as in the core paper: texels hold premultiplied colour and the opacity of a reference length,
// filtered together. Corrected to the layer's own length along this ray.
uniform sampler3D volumeTexels;

vec4 classify(vec3 uvw, float lengthMm, Ray ray) {
    vec4 texel = textureLod(volumeTexels, uvw, 0.0);
    countFetches(1);
    // (1 - a)^k; at a = 1 the logarithm is -inf and the power 0, as it should be; 1e-30 avoids 0 * inf at k = 0.
    float depth = -log(max(1.0 - texel.a, 1.0e-30)) * (lengthMm * tableMap.z);
    float alpha = opacityOfDepth(depth);
    return vec4(texel.rgb * (alpha / max(texel.a, 1.0e-6)), alpha);
}

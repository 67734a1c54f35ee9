// Pre-classification, as in the core paper: texels hold premultiplied colour and the opacity of a
// reference length, filtered together. Corrected to the layer's own length along this ray.
#include "segment/classification/sample_middle.glsl"
uniform sampler3D volumeTexels;

vec4 classify(vec3 uvw, Ray ray, int i) {
    vec4 texel = textureLod(volumeTexels, uvw, 0.0);
    countFetches(1);
    if (texel.a == 0.0) {
        return vec4(0.0);
    }
    // (1 - a)^k. Opaque texels are taken as 1 - 1e-30, so that k = 0 gives 0 and not 0 * infinity.
    precise float depth = -log(max(1.0 - texel.a, 1.0e-30)) * (lengthInside(ray, i) * tableMap.z);
    float alpha = opacityOfDepth(depth);
    return vec4(texel.rgb * (alpha / texel.a), alpha);
}

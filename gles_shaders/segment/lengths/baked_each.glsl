// As baked.glsl, for segments so short that each layer is weighed where it is.
#include "segment/lengths/each_layer.glsl"
#include "segment/lengths/opacity.glsl"
#include "segment/lengths/of_opacity.glsl"

float fullLight(vec4 layer) {
    return layer.a;
}

/// A whole layer stays as it is.
void addLayer(inout Sum sum, inout float front, Ray ray, Segment segment, float k) {
    vec4 layer = layerAt(ray, segment, k, front);
    float part = partInside(segment, k);
    add(sum, mix(ofLength(layer, part), layer, bvec4(part == 1.0)));
}

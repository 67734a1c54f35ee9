// Layers are of another length along every ray: their opacity is made here, of what is inside.
#include "segment/lengths/each_layer.glsl"
#include "segment/lengths/opacity.glsl"
#include OF_LENGTH_FILE

float fullLight(vec4 found) {
    return 1.0;
}

void addLayer(inout Sum sum, inout float front, Ray ray, Segment segment, float k) {
    // Halvings of light per unit of a texel's alpha.
    float perLayer = ray.layerLength * step0.w;
    add(sum, ofLength(layerAt(ray, segment, k, front), perLayer * partInside(segment, k)));
}

// Pre-classification, as in the core paper: texels hold premultiplied colour and the opacity of a
// reference length, filtered together.
#include "segment/classification/sample_middle.glsl"
uniform sampler3D volumeTexels;

vec4 layerAt(Ray ray, Segment segment, float k, inout float front) {
    countFetches(1);
    return textureLod(volumeTexels, middleOf(ray, segment, k), 0.0);
}

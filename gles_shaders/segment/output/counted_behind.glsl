// Counts what fetched.glsl does: the layer is drawn beside, plane by plane.
#include "segment/output/counted.glsl"
uniform highp sampler2D layerBefore;

highp float opacityBefore() {
    return texelFetch(layerBefore, ivec2(gl_FragCoord.xy), 0).a;
}

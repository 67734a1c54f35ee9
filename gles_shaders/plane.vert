// One proxy plane per instance, back to front. The unit polygon is static; where it lies comes from
// the outlines.
#include "frame.glsl"

layout(location = 0) in vec2 unitPolygon;
flat out int plane;

void main() {
    int fromBack = planeCount - 1 - gl_InstanceID;
    plane = firstPlane + fromBack;
    vec4 outline = outlines[fromBack / planesPerOutline];
    // w = 1 and z = 0: near and far never clip a proxy polygon.
    gl_Position = vec4(outline.xy + unitPolygon * outline.zw, 0.0, 1.0);
}

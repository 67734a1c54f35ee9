// One proxy plane per instance. The unit polygon is static; where it lies comes from the outlines,
// which are counted from the nearest plane.
#include "segment/frame.glsl"
#define firstPlane counts.x
#define layersPerPlane counts.y
#define planesPerOutline counts.z

layout(std140) uniform OutlineBlock {
    vec4 outlines[MAX_OUTLINES]; // xy: centre, zw: half size, normalised device coordinates
};
layout(location = 0) in vec2 unitPolygon;
flat out float planeFront;
uniform ivec2 planeRun; // the first instance's place from the nearest; the step to the next

void main() {
    int fromNearest = planeRun.x + planeRun.y * gl_InstanceID;
    // Halves of layers: exact.
    planeFront = float((firstPlane + fromNearest) * layersPerPlane) - centre0.w;
    vec4 outline = outlines[fromNearest / planesPerOutline];
    // w = 1 and z = 0: near and far never clip a proxy polygon.
    gl_Position = vec4(outline.xy + unitPolygon * outline.zw, 0.0, 1.0);
}

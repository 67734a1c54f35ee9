// Front to back across planes: what the planes before have gathered counts too, so that a ray is
// left where it would be in one segment, and a plane behind at its first layer.
bool terminated(float alpha) {
    float before = opacityBefore();
    precise float gathered = before + (1.0 - before) * alpha;
    return gathered > viewport.w;
}
#include "segment/termination/closed.glsl"

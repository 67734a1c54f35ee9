bool terminated(float alpha) {
    return alpha > viewport.w;
}
#include "segment/termination/closed.glsl"

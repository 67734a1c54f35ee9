bool terminated(float alpha) {
    return alpha > viewport.w;
}
#include "terminate_closed.glsl"

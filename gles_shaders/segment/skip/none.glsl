// Nothing is skipped: one stretch for the whole ray.
#include "segment/skip/stretch.glsl"

bool segmentIsEmpty(Ray ray, ivec2 range) {
    return false;
}

Stretch stretchAt(vec3 uvw, Ray ray) {
    return Stretch(1 << 24, false);
}

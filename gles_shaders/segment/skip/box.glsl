// Skipping by boxes: what is found at a place holds in all of an axis-aligned box around it.
#include "segment/skip/stretch.glsl"

/// In blocks or leaves. Where it meets the volume's face it goes on beyond: there the field is the
/// face's.
struct Box {
    vec3 low;
    vec3 high;
};

ivec3 blockAt(vec3 position) {
    return clamp(ivec3(floor(position)), ivec3(0), skipBlocks.xyz);
}

/// Samples of the ray from `position` on that lie in the box, itself included. Boxes are tested
/// with a voxel's margin, so rounding at their faces does not matter.
int samplesInBox(Box box, vec3 position, Ray ray) {
    vec3 face = mix(box.low, box.high, greaterThan(ray.step, vec3(0.0)));
    vec3 offset = (face - position) * ray.inverseStep / skipMap.xyz;
    vec3 crossing = mix(offset, vec3(1.0e6), equal(ray.inverseStep, vec3(kFar)));
    return int(clamp(min(crossing.x, min(crossing.y, crossing.z)), 0.0, 1.0e6)) + 1;
}

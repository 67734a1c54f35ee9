// Skipping by boxes: what is found at a place holds in all of an axis-aligned box around it.
#include "skip_stretch.glsl"

/// In blocks or leaves. Where it meets the volume's face it goes on beyond: there the field is the
/// face's.
struct Box {
    vec3 low;
    vec3 high;
    bool free; // certain to be invisible
};

#include BOX_FILE

/// Offset, in layers, at which the ray leaves the box.
float offsetToExit(Box box, vec3 position, Ray ray) {
    vec3 face = mix(box.low, box.high, greaterThan(ray.step, vec3(0.0)));
    vec3 offset = (face - position) * ray.inverseStep / skipMap.xyz;
    vec3 crossing = mix(offset, vec3(1.0e6), equal(ray.inverseStep, vec3(kFar)));
    return min(crossing.x, min(crossing.y, crossing.z));
}

/// The box in the segment's middle proves all of it empty, where it holds both ends.
bool segmentIsEmpty(Ray ray, ivec2 range) {
    int last = range.y - 1 + kSharedEnds; // sample
    Box box = boxAt(samplePosition(ray, (range.x + last) / 2) * skipMap.xyz);
    vec3 inside = vec3(skipBlocks.xyz + 1);
    vec3 a = clamp(samplePosition(ray, range.x) * skipMap.xyz, vec3(0.0), inside);
    vec3 b = clamp(samplePosition(ray, last) * skipMap.xyz, vec3(0.0), inside);
    return box.free && all(greaterThanEqual(min(a, b), box.low)) &&
           all(lessThanEqual(max(a, b), box.high));
}

/// Boxes are tested with a voxel's margin, so rounding at their faces does not matter.
Stretch stretchAt(vec3 uvw, Ray ray) {
    vec3 position = uvw * skipMap.xyz;
    Box box = boxAt(position);
    return stretchOf(int(clamp(offsetToExit(box, position, ray), 0.0, 1.0e6)) + 1, box.free);
}

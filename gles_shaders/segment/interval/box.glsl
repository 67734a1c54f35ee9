// A ray's stay in the volume's box.

/// Offsets at which one coordinate lies in [0, 1].
vec2 slabOffsets(float centre, float inverseSlope) {
    if (inverseSlope == kFar) {
        return centre >= 0.0 && centre <= 1.0 ? vec2(-kFar, kFar) : vec2(kFar, -kFar);
    }
    precise float a = (0.0 - centre) * inverseSlope;
    precise float b = (1.0 - centre) * inverseSlope;
    return vec2(min(a, b), max(a, b));
}

void cutStay(inout Ray ray) {
    vec2 x = slabOffsets(ray.centre.x, ray.inverseStep.x);
    vec2 y = slabOffsets(ray.centre.y, ray.inverseStep.y);
    vec2 z = slabOffsets(ray.centre.z, ray.inverseStep.z);
    ray.entry = max(max(x.x, y.x), max(z.x, ray.entry));
    ray.exit = min(min(x.y, y.y), z.y);
}

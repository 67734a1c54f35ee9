// The ray of a fragment, in units of layers: at offset o it is at centre + o * step. Mirrors
// rayAt() in core/frame/lattice.cpp.
struct Ray {
    vec3 centre;
    vec3 step;
    vec3 inverseStep; // kFar along axes that the ray does not move along
    float layerLengthMm;
    float entry; // offsets between which the ray is inside the box and beyond the near plane
    float exit;
};

const float kFar = 1.0e30;

/// Offsets at which one coordinate lies in [0, 1].
vec2 slabOffsets(float centre, float inverseSlope) {
    if (inverseSlope == kFar) {
        return centre >= 0.0 && centre <= 1.0 ? vec2(-kFar, kFar) : vec2(kFar, -kFar);
    }
    precise float a = (0.0 - centre) * inverseSlope;
    precise float b = (1.0 - centre) * inverseSlope;
    return vec2(min(a, b), max(a, b));
}

/// Mirrors jitterOf() in core/frame/lattice.cpp: interleaved gradient noise in integers, from -1/2
/// to 1/2.
float jitterOf(uvec2 pixel) {
    uint noise = ((pixel.x * 288237660u + pixel.y * 25070368u) >> 8) * 13564u;
    return float(noise >> 8) * (1.0 / 16777216.0) - 0.5;
}

Ray rayOfFragment(vec2 fragCoord) {
    precise vec2 p = fragCoord - viewport.xy;
    precise vec2 t = tangent.xy + tangent.zw * p;
    precise float lengthPerDepth = sqrt(1.0 + dot(t, t));
    precise vec3 direction = direction0.xyz + directionX.xyz * p.x + directionY.xyz * p.y;

    Ray ray;
    precise vec3 centre = centre0.xyz + centreX.xyz * p.x + centreY.xyz * p.y;
    precise vec3 step;
    precise float layerLengthMm;
    precise float nearOffset;
    if (viewport.z == 0.0) {
        step = direction * direction0.w;
        layerLengthMm = direction0.w * lengthPerDepth * directionY.w;
        nearOffset = centreX.w;
    } else {
        // From the sphere's depth to its distance. The quotient is the difference
        // sphere.w - depth * length without its cancellation, nor that of depth * t - sphere.xy,
        // which the host resolves; behind the eye there is none, and the quotient's divisor may
        // vanish.
        precise vec2 missed = miss.xy + miss.zw * p;
        precise float far =
            dot(missed, sphere.z * t + sphere.xy) / (sphere.w + sphere.z * lengthPerDepth);
        precise float toShell = sphere.z > 0.0 ? -far : sphere.w - sphere.z * lengthPerDepth;
        precise vec3 perLength = direction / lengthPerDepth;
        centre += perLength * toShell;
        step = perLength * direction0.w;
        layerLengthMm = direction0.w * directionY.w;
        nearOffset = (centreY.w * lengthPerDepth - sphere.w) * directionX.w;
    }
    if (jitter.z != 0) {
        precise float moved = jitterOf(uvec2(ivec2(fragCoord) - jitter.xy));
        centre += moved * step;
        nearOffset -= moved;
    }
    ray.centre = centre;
    ray.step = step;
    ray.layerLengthMm = layerLengthMm;
    ray.inverseStep = mix(1.0 / step, vec3(kFar), lessThan(abs(step), vec3(1.0e-25)));
    vec2 x = slabOffsets(centre.x, ray.inverseStep.x);
    vec2 y = slabOffsets(centre.y, ray.inverseStep.y);
    vec2 z = slabOffsets(centre.z, ray.inverseStep.z);
    ray.entry = max(max(x.x, y.x), max(z.x, nearOffset));
    ray.exit = min(min(x.y, y.y), z.y);
    return ray;
}

/// The layers of this plane that meet the ray's part inside: half-open.
ivec2 layersOfPlane(Ray ray, int plane) {
    int first = plane * layersPerPlane;
    if (ray.entry >= ray.exit) {
        return ivec2(first);
    }
    float low = float(first);
    float high = float(first + layersPerPlane);
    float begin = clamp(floor(ray.entry + centre0.w), low, high);
    float end = clamp(ceil(ray.exit + centre0.w), low, min(high, 2.0 * centre0.w));
    return ivec2(int(begin), int(end));
}

/// Length of layer i inside the box, mm.
float lengthInside(Ray ray, int i) {
    float low = float(i) - centre0.w;
    precise float inside =
        clamp(min(ray.exit, low + 1.0) - max(ray.entry, low), 0.0, 1.0) * ray.layerLengthMm;
    return inside;
}

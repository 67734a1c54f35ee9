// The ray of a fragment, in units of layers: at offset o it is at centre + o * step. Mirrors
// rayAt() in core/view/lattice.cpp.
struct Ray {
    vec3 centre;
    vec3 step;
    vec3 inverseStep; // kFar along axes that the ray does not move along
    float layerLengthMm;
    float entry; // offsets of its stay: inside the interval and beyond the near plane
    float exit;
};

const float kFar = 1.0e30;

/// What a lattice is laid along.
struct EyeRay {
    vec2 pixel; // from the viewport's centre
    vec2 slope; // (x, y) / depth
    float lengthPerDepth;
    vec3 centre;    // uvw at the depth of the sphere's centre
    vec3 direction; // uvw per unit of depth
};

#include LATTICE_FILE
#include JITTER_FILE
#include INTERVAL_FILE

Ray rayOfFragment(vec2 fragCoord) {
    precise vec2 p = fragCoord - viewport.xy;
    precise vec2 t = tangent.xy + tangent.zw * p;
    precise float lengthPerDepth = sqrt(1.0 + dot(t, t));
    precise vec3 direction = direction0.xyz + directionX.xyz * p.x + directionY.xyz * p.y;
    precise vec3 centre = centre0.xyz + centreX.xyz * p.x + centreY.xyz * p.y;

    Ray ray = rayOnLattice(EyeRay(p, t, lengthPerDepth, centre, direction));
    jitterRay(fragCoord, ray);
    ray.inverseStep = mix(1.0 / ray.step, vec3(kFar), lessThan(abs(ray.step), vec3(1.0e-25)));
    cutStay(ray);
    return ray;
}

/// The layers of this plane that meet the ray's stay: half-open.
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

/// Length of layer i within the stay, mm.
float lengthInside(Ray ray, int i) {
    float low = float(i) - centre0.w;
    precise float inside =
        clamp(min(ray.exit, low + 1.0) - max(ray.entry, low), 0.0, 1.0) * ray.layerLengthMm;
    return inside;
}

// The ray of a fragment, in units of layers: at offset o it is at centre + o * step. Mirrors
// rayAt() in core/view/lattice.cpp.
struct Ray {
    vec3 centre;
    vec3 step;
    float layerLength; // in spacings of the lattice
    float nearOffset;  // of the near plane
};

/// What is affine in the pixel: its coefficients are the host's.
vec3 affine(vec3 at0, vec3 perX, vec3 perY, vec2 p) {
    precise vec3 sum = fma(perX, vec3(p.x), fma(perY, vec3(p.y), at0));
    return sum;
}

/// Square of a ray's length per unit of depth.
float squaredLengthPerDepth(vec2 p) {
    precise vec2 slope = fma(tangent.zw, p, tangent.xy);
    precise float square = fma(slope.x, slope.x, fma(slope.y, slope.y, 1.0));
    return square;
}

#include INTERVAL_FILE
#include LATTICE_FILE
#include JITTER_FILE

Ray rayOfFragment(vec2 fragCoord) {
    Ray ray = rayOnLattice(fragCoord - viewport.xy);
    jitterRay(fragCoord, ray);
    return ray;
}

/// Where a segment's layer k begins, half a layer more its middle: exact, and so the same place
/// however the layers are dealt out to planes.
vec3 placeOf(Ray ray, Segment segment, float k) {
    precise vec3 place = fma(ray.step, vec3(segment.front + k), ray.centre);
    return place;
}

// Emission and absorption, front to back: a sum of premultiplied colour and opacity. Planes are
// blended over or under each other.
#include TERMINATION_FILE

vec4 started() {
    return vec4(0.0);
}

/// Precise, as is all that decides a pixel: variants are different programs, and a compiler that
/// fused one and not the other would make skipping change the last bit.
vec4 added(vec4 sum, vec4 layer) {
    precise vec4 result = inSum(sum + inSum(inSum(1.0 - sum.a) * layer));
    return result;
}

bool done(vec4 sum) {
    return terminated(sum.a);
}

vec4 resultOf(vec4 sum, bool layersLeft) {
    return closed(sum, layersLeft);
}

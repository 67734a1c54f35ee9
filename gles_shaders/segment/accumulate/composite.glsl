// Emission and absorption, front to back: a sum of premultiplied colour and opacity. Planes are
// blended over or under each other.
#include TERMINATION_FILE

struct Sum {
    vec4 colour;
    float passing; // share of light from behind: the same as 1 - opacity, but for rounding, so that
                   // no layer waits for a difference
};

Sum started() {
    return Sum(vec4(0.0), 1.0);
}

/// A layer, or where `share` is 0 nothing of it. Precise, as is all that decides a pixel: variants
/// are different programs, and a compiler that fused one and not the other would make skipping
/// change the last bit.
void addShare(inout Sum sum, vec4 layer, float share) {
    precise float passing = sum.passing * share;
    precise vec4 colour = inSum(fma(layer, vec4(passing), sum.colour));
    precise float left = inSum(fma(-layer.a, passing, sum.passing));
    sum = Sum(colour, left);
}

/// A slice's only layer is the sum as it is. Times 1 and plus 0 says the same, but what is precise is
/// multiplied by 1 all the same (Mesa's compilers): a tenth of a slice that nothing cuts.
void add(inout Sum sum, vec4 layer) {
    if (GROUP == 1) {
        sum.colour = inSum(layer);
    } else {
        addShare(sum, layer, 1.0);
    }
}

bool done(Sum sum) {
    return terminated(sum.colour.a);
}

vec4 resultOf(Sum sum) {
    return closed(sum.colour);
}

// What mediump may do: every result of the named operations is rounded to fp16, to nearest or toward
// zero. For measuring where mediump is safe. HALF_GROUPS: bits of core/plan/shader_variant.h. Nothing
// else is rounded: some desktop drivers do hold mediump in 16 bits (Mesa's llvmpipe, where the
// processor converts them).
#define mediump highp
float halved(float x) {
    uint bits = floatBitsToUint(x);
    bool cutOff = (HALF_GROUPS & 32) != 0;
    uint kept = (cutOff ? bits : bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu;
    // Steps of 2^-24, as fp16 has below 2^-14.
    precise float small = cutOff ? trunc(x * 16777216.0) / 16777216.0 : (x + 0.75) - 0.75;
    float nearest = abs(x) < 6.103515625e-5 ? small : uintBitsToFloat(kept);
    return abs(nearest) > 65504.0 ? sign(x) / 0.0 : nearest;
}
vec3 halved(vec3 x) { return vec3(halved(x.x), halved(x.y), halved(x.z)); }
vec4 halved(vec4 x) { return vec4(halved(x.xyz), halved(x.w)); }

#define whereSet(bit, x) ((HALF_GROUPS & bit) != 0 ? halved(x) : (x))
#define inOpacity(x) whereSet(1, x)
#define inSum(x) whereSet(2, x)
#define inColour(x) whereSet(4, x)
#define inExtinction(x) whereSet(16, x)
#define inLight(x) whereSet(8, x)

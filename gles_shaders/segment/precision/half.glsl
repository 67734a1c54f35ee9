// What mediump may do and no desktop driver shows: every result of the named operations is rounded
// to fp16, to nearest. For measuring where mediump is safe. HALF_GROUPS: bits of core/plan/
// shader_variant.h.
float halved(float x) {
    uint bits = floatBitsToUint(x);
    uint kept = (bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu;
    precise float small = (x + 0.75) - 0.75; // steps of 2^-24, as fp16 has below 2^-14
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

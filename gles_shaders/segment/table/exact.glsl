// The table between two texels from both of them, interpolated here: texture units may filter with
// 8-bit weights. Colours are mediump: their rounding stays below half an 8-bit step (`slabcast
// stability`, half precision); a device that does round them promises that skipping changes nothing
// only to that rounding.
vec4 tableAt(float value) {
    precise float at = clamp((value - tableMap.y) * tableMap.x, 0.0, tableMap.w);
    int texel = int(at);
    vec4 low = texelFetch(transferTable, ivec2(texel, 0), 0);
    vec4 high = texelFetch(transferTable, ivec2(min(texel + 1, int(tableMap.w)), 0), 0);
    float part = at - float(texel);
    precise float denser = inExtinction(inExtinction(high.a - low.a) * part);
    precise float extinction = inExtinction(low.a + denser);
    mediump vec3 rise = inColour(high.rgb - low.rgb);
    precise mediump vec3 colour = inColour(low.rgb + inColour(rise * part));
    return vec4(colour, extinction);
}

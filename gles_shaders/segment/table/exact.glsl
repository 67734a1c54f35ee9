// The table between two texels from both of them, interpolated here: texture units may filter with
// 8-bit weights.
vec4 tableAt(float value) {
    precise float at = clamp((value - tableMap.y) * tableMap.x, 0.0, tableMap.w);
    int texel = int(at);
    vec4 low = texelFetch(transferTable, ivec2(texel, 0), 0);
    vec4 high = texelFetch(transferTable, ivec2(min(texel + 1, int(tableMap.w)), 0), 0);
    float part = at - float(texel);
    precise float denser = inExtinction(inExtinction(high.a - low.a) * part);
    precise float extinction = inExtinction(low.a + denser);
    vec3 rise = inColour(high.rgb - low.rgb);
    precise vec3 colour = inColour(low.rgb + inColour(rise * part));
    return vec4(colour, extinction);
}

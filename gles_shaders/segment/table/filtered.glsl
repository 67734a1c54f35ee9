// The table by the texture unit's filter: what is zero in both texels is exactly zero between them,
// where the device's self-test says so. The host's map has the half texel and the size in it.
vec4 tableAt(float value) {
    precise float at = fma(value, tableMap.x, tableMap.y);
    return textureLod(transferTable, vec2(at, 0.5), 0.0);
}

/// From a premultiplied colour and the opacity of a reference length: 1 - (1 - a)^length. Opaque
/// texels are taken as 1 - 1e-30, so that a length of 0 gives 0 and not 0 * infinity.
vec4 ofLength(vec4 texel, float length) {
    float alpha = opacityOf(-log2(max(1.0 - texel.a, 1.0e-30)) * length);
    precise vec3 colour = texel.rgb * (alpha / max(texel.a, 1.0e-30));
    return vec4(colour, alpha);
}

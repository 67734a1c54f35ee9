/// From a colour and an extinction.
vec4 ofLength(vec4 found, float length) {
    float alpha = opacityOf(found.a * length);
    return vec4(inColour(found.rgb * alpha), alpha);
}

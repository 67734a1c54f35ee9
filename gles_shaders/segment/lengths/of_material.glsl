/// From a colour and an extinction.
vec4 ofLength(vec4 material, float length) {
    float alpha = opacityOf(material.a * length);
    return vec4(inColour(material.rgb * alpha), alpha);
}

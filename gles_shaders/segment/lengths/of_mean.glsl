/// From the mean of extinction times colour, and of extinction.
vec4 ofLength(vec4 mean, float length) {
    float alpha = opacityOf(mean.a * length);
    precise vec3 colour = mean.rgb * (alpha / max(mean.a, 1.0e-30));
    return vec4(colour, alpha);
}

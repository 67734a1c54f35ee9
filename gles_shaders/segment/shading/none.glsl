mediump vec3 shade(mediump vec3 colour, float full, vec3 uvw, Ray ray) {
    return colour;
}

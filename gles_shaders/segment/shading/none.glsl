vec3 shade(vec3 colour, float full, vec3 uvw, Ray ray) {
    return colour;
}

vec3 shade(vec3 colour, vec3 uvw, Ray ray) {
    return colour;
}

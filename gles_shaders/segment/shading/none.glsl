mediump vec3 shade(mediump vec3 colour, vec3 uvw, Ray ray) {
    return colour;
}

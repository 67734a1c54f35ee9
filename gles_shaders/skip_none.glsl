bool segmentIsEmpty(Ray ray, ivec2 range) {
    return false;
}

/// Layers from this sample on that are certain to be invisible.
int freeLayers(vec3 uvw, Ray ray) {
    return 0;
}

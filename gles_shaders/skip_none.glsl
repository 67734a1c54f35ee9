// Nothing is skipped: one stretch for the whole ray.
struct Stretch {
    int layers; // from the sample on, the sample included
    bool free;  // certain to be invisible
};

bool segmentIsEmpty(Ray ray, ivec2 range) {
    return false;
}

Stretch stretchAt(vec3 uvw, Ray ray) {
    return Stretch(1 << 24, false);
}

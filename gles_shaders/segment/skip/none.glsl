// Nothing is skipped.
const bool kLooks = false;

bool isFree(Ray ray, Segment segment, float first, float last) {
    return false;
}

float freeThrough(Ray ray, Segment segment, float first) {
    return first - 1.0;
}

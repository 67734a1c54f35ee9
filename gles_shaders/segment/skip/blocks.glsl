// Where a sample lies in a skip structure.
const bool kLooks = true;

/// Of sample k, in blocks or leaves; of one outside the volume the nearest that is in it. The host
/// keeps the far faces a little below a whole number.
vec3 blocksAt(Ray ray, Segment segment, float k) {
    return clamp(placeOf(ray, segment, k + kSampleAt), 0.0, 1.0) * skipMap.xyz;
}

/// What a look at sample `first` found: how far samples are free.
float freeWhere(bool found, float first, float layers) {
    countLook(found);
    return found ? first + max(layers, 0.0) : first - 1.0;
}

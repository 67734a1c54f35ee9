// A ray's stay: in the volume's box, and beyond the near plane.
const bool kEyeIsOutside = false;

struct Segment {
    float front; // offset of its first layer's front
    float entry; // of the stay, in layers from there; below 0: before it
    float exit;  // at most the plane's layers; below 0 where none of them is inside
};

/// A ray along an axis divides by next to nothing, and one in a face lies inside: the box is wider
/// by the rounding of a coordinate.
Segment segmentOf(Ray ray, float front) {
    const float kHalf = 0.5 * (1.0 + 1.1920929e-7);
    precise vec3 inverse = 1.0 / (ray.step + 1.0e-30);
    precise vec3 middle = (0.5 - ray.centre) * inverse;
    precise vec3 near = fma(abs(inverse), vec3(-kHalf), middle);
    precise vec3 far = fma(abs(inverse), vec3(kHalf), middle);
    precise float entry = max(max(near.x, near.y), max(near.z, ray.nearOffset)) - front;
    precise float exit = min(min(min(far.x, far.y), far.z) - front, viewport.z);
    return Segment(front, entry, entry < exit ? exit : -1.0);
}

/// Whether any of n layers from k on is inside.
bool reaches(Segment segment, float k, float n) {
    return k < segment.exit && segment.entry < k + n;
}

/// Part of layer k that is inside.
float partInside(Segment segment, float k) {
    precise float part = clamp(segment.exit - k, 0.0, 1.0) - clamp(segment.entry - k, 0.0, 1.0);
    return part;
}

/// Without the layers that are inside in part.
Segment wholeLayers(Segment segment) {
    float entry = ceil(segment.entry);
    float exit = floor(segment.exit);
    return Segment(segment.front, entry, entry < exit ? exit : -1.0);
}

/// The layer that the stay begins in, or ends in, where it is one of the segment's that is inside in
/// part; else below 0. One that holds both is the beginning.
float cutAtEntry(Segment segment) {
    float k = floor(segment.entry);
    float part = partInside(segment, k);
    return part > 0.0 && part < 1.0 ? k : -1.0;
}
float cutAtExit(Segment segment) {
    float k = floor(segment.exit);
    return k > segment.entry && segment.exit > k ? k : -1.0;
}

/// The nearest place in the stay.
float kept(Segment segment, float at) {
    return clamp(at, segment.entry, segment.exit);
}

/// The segment's first layer that counts, and where they end.
float firstLayer(Segment segment) {
    return floor(max(segment.entry, 0.0));
}
float endOfLayers(Segment segment) {
    return segment.exit;
}

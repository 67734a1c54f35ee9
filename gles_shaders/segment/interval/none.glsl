// No stay is cut: nothing visible is near the volume's faces, the near plane or the eye, so samples
// outside read what is invisible and add exactly 0.
const bool kEyeIsOutside = true;

struct Segment {
    float front; // offset of its first layer's front
};

Segment segmentOf(Ray ray, float front) {
    return Segment(front);
}

bool reaches(Segment segment, float k, float n) {
    return true;
}

float partInside(Segment segment, float k) {
    return 1.0;
}

float cutAtEntry(Segment segment) {
    return -1.0;
}
float cutAtExit(Segment segment) {
    return -1.0;
}

float kept(Segment segment, float at) {
    return at;
}

/// Layers of one length, of which none is cut.
Segment wholeLayers(Segment segment) {
    return segment;
}

/// The segment's first layer that counts, and where they end.
float firstLayer(Segment segment) {
    return 0.0;
}
float endOfLayers(Segment segment) {
    return viewport.z;
}

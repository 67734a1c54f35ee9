// A layer is one sample, in its middle.
const float kSampleAt = 0.5; // of a layer
const int kSharedEnds = 0;   // samples that neighbouring layers have in common

float frontOf(Ray ray, Segment segment, float k) {
    return 0.0; // nothing goes on from layer to layer
}

vec3 middleOf(Ray ray, Segment segment, float k) {
    return placeOf(ray, segment, k + kSampleAt);
}

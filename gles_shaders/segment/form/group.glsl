// A group of layers in a row: no branch between its fetches, and what stands between groups decides
// whether it counts. One look at the skip structure proves all of it invisible; else all of it is
// composited, what is invisible adding exactly 0. Layer by layer, not all fetches first: a compiler
// that has registers to hold them moves fetches up by itself, and one that has not gains a thread
// (Mesa's, of Valhall).

#define ADD_LAYER(k) addLayer(sum, front, ray, segment, k0 + float(k));
void addGroup(inout Sum sum, Ray ray, Segment segment, float k0) {
    countLayers(GROUP);
    float front = frontOf(ray, segment, k0);
    GROUP_LAYERS(ADD_LAYER)
}

/// The last sample of a group.
float lastOf(float k0) {
    return k0 + float(GROUP - 1 + kSharedEnds);
}

// A group of layers in a row, without a branch between its fetches: what stands between groups decides
// whether it counts, and what does not count of it adds exactly 0. Layer by layer, not all fetches
// first: a compiler that has registers to hold them moves fetches up by itself, and one that has not
// gains a thread (Mesa's, of Valhall).

#define ADD_LAYER(k) addLayer(sum, front, ray, segment, k0 + float(k)), endLayer(sum);
void addGroup(inout Sum sum, Ray ray, Segment segment, float k0) {
    countLayers(GROUP);
    float front = frontOf(ray, segment, k0);
    GROUP_LAYERS(ADD_LAYER)
}

// A segment as a loop over groups, for lengths beyond the unroll list. Leaping and compositing are
// loops of their own, so that neighbouring fragments leap together and then composite together. A
// group begins wherever a leap ends, so the layer at which a sum becomes as good as opaque is the
// last that counts, whatever group it is in: skipping changes nothing.
void endLayer(inout Sum sum) {
    sum.passing = done(sum) ? 0.0 : sum.passing;
}
#include "segment/form/group.glsl"

vec4 march(Ray ray, Segment segment) {
    Sum sum = started();
    Segment inGroups = composited(segment);
    addEntry(sum, ray, segment);
    float k = firstLayer(inGroups);
    float end = endOfLayers(inGroups);
    while (k < end && !done(sum)) {
        float leapt = kLooks ? 1.0 : 0.0;
        while (leapt > 0.0 && k < end) {
            // A layer is free whose samples all are.
            float next = floor(freeThrough(ray, inGroups, k)) + float(1 - kSharedEnds);
            leapt = max(next - k, 0.0);
            k += leapt;
        }
        if (k < end) {
            addGroup(sum, ray, inGroups, k);
            k += float(GROUP);
        }
    }
    addExit(sum, ray, segment);
    return resultOf(sum);
}

/// Of groups in a row, where nothing is leapt over.
float layersInGroups(Segment segment) {
    float layers = endOfLayers(segment) - firstLayer(segment);
    return max(ceil(layers * (1.0 / float(GROUP))), 0.0) * float(GROUP);
}

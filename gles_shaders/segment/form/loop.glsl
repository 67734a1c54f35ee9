// A segment as a loop over groups, for lengths beyond the unroll list. Leaping and compositing are
// loops of their own, so that neighbouring fragments leap together and then composite together.
#include "segment/form/group.glsl"

/// Groups from k on that are known to be free where samples up to `through` are.
float freeGroups(float k, float through) {
    return max(floor((through - lastOf(k)) * (1.0 / float(GROUP))) + 1.0, 0.0);
}

vec4 march(Ray ray, Segment segment) {
    Sum sum = started();
    Segment inGroups = composited(segment);
    addEntry(sum, ray, segment);
    float k = firstGroup(inGroups);
    float end = endOfLayers(inGroups);
    while (k < end && !done(sum)) {
        float leapt = kLooks ? 1.0 : 0.0;
        while (leapt > 0.0 && k < end) {
            leapt = freeGroups(k, freeThrough(ray, inGroups, k, lastOf(k)));
            k += float(GROUP) * leapt;
        }
        if (k < end) {
            addGroup(sum, ray, inGroups, k);
            k += float(GROUP);
        }
    }
    addExit(sum, ray, segment);
    return resultOf(sum);
}

// A segment without a loop: the host writes REPEAT_GROUPS(X) as X(0.0) X(8.0) ... for the variant's
// length. One look at the skip structure proves a group free, and a group is left out once the sum
// is as good as opaque.
void endLayer(Sum sum) {}
#include "segment/form/group.glsl"

void compositeGroup(inout Sum sum, Ray ray, Segment segment, float k0) {
    float last = k0 + float(GROUP - 1 + kSharedEnds); // sample
    if (reaches(segment, k0, float(GROUP)) && !done(sum) &&
        !(kLooks && isFree(ray, segment, k0, last))) {
        addGroup(sum, ray, segment, k0);
    }
}

#define COMPOSITE_GROUP(k0) compositeGroup(sum, ray, inGroups, k0);
vec4 march(Ray ray, Segment segment) {
    Sum sum = started();
    Segment inGroups = composited(segment);
    addEntry(sum, ray, segment);
    REPEAT_GROUPS(COMPOSITE_GROUP)
    addExit(sum, ray, segment);
    return resultOf(sum);
}

/// Of the groups that are inside, in whole or in part.
float layersInGroups(Segment segment) {
    float begin = floor(firstLayer(segment) * (1.0 / float(GROUP)));
    return max(ceil(endOfLayers(segment) * (1.0 / float(GROUP))) - begin, 0.0) * float(GROUP);
}

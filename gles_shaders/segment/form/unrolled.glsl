// A segment without a loop: the host writes REPEAT_GROUPS(X) as X(0.0) X(8.0) ... for the variant's
// length.
#include "segment/form/group.glsl"

void compositeGroup(inout Sum sum, Ray ray, Segment segment, float k0) {
    if (reaches(segment, k0, float(GROUP)) && !done(sum) &&
        !(kLooks && isFree(ray, segment, k0, lastOf(k0)))) {
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

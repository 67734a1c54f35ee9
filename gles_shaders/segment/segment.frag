// A fragment of a proxy plane: composites its segment of the ray, front to back. Planes are blended
// over or under each other.
#include OUTPUT_FILE
#include "segment/frame.glsl"
flat in int plane;

#include "segment/ray.glsl"
#include PRECISION_FILE
#include "segment/opacity.glsl"
#include COUNTING_FILE
#include CLASSIFICATION_FILE
#include SKIP_FILE
#include ACCUMULATE_FILE
#include FORM_FILE

void main() {
    Ray ray = rayOfFragment(gl_FragCoord.xy);
    ivec2 range = layersOfPlane(ray, plane);
    ivec2 live = range;
    if (range.x < range.y && (done(started()) || segmentIsEmpty(ray, range))) {
        live.y = live.x;
    }
    writeResult(march(ray, live), range);
}

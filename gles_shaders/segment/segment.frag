// A fragment of a proxy plane: composites its segment of the ray, front to back. Planes are blended
// over or under each other.
#include OUTPUT_FILE
#include "segment/frame.glsl"
flat in float planeFront; // offset of the plane's first layer from the lattice's centre, in layers

#include "segment/ray.glsl"
#include PRECISION_FILE
#include COUNTING_FILE
#include CLASSIFICATION_FILE
#include ACCUMULATE_FILE
#include LENGTHS_FILE
#include SKIP_FILE
#include FORM_FILE

void main() {
    Ray ray = rayOfFragment(gl_FragCoord.xy);
    Segment segment = segmentOf(ray, planeFront);
    writeResult(march(ray, segment), layersOf(segment));
}

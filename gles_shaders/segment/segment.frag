// A fragment of a proxy plane: composites its segment of the ray, front to back. Planes are blended
// over or under each other.
#include TARGET_FILE
#include "segment/frame.glsl"
flat in int plane;

#include "segment/ray.glsl"
#include MEDIUM_FILE
#include "segment/opacity.glsl"
#include COUNT_FILE
#include CLASSIFY_FILE
#include SKIP_FILE
#include TERMINATE_FILE
#include MARCH_FILE

void main() {
    Ray ray = rayOfFragment(gl_FragCoord.xy);
    ivec2 range = layersOfPlane(ray, plane);
    ivec2 live = range;
    if (range.x < range.y && (terminated(0.0) || segmentIsEmpty(ray, range))) {
        live.y = live.x;
    }
    writeResult(march(ray, live), range);
}

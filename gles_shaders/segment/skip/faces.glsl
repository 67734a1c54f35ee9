// Skipping by boxes: what is found at a place holds in all of an axis-aligned box around it. Boxes
// are tested with a voxel's margin, so rounding at their faces does not matter.
#include "segment/skip/blocks.glsl"

/// Layers from a place in the box to where the ray leaves it.
float layersAhead(Ray ray, vec3 place, vec3 centre, vec3 halfEdge) {
    vec3 perLayer = ray.step * skipMap.xyz;
    vec3 layers = (halfEdge - sign(perLayer) * (place - centre)) / (abs(perLayer) + 1.0e-30);
    return min(layers.x, min(layers.y, layers.z));
}

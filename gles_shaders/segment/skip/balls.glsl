// Proximity clouds (Tukora 2020, section 2.3): 0 where something visible may be met, else 1 + the
// free distance around any point of the block; skipMap.w counts go to a spacing of the lattice. See
// core/skip/proximity_cloud.h.
#include "segment/skip/faces.glsl"
#include "segment/skip/grid.glsl"

// Samples strictly within the free length are free. Outside of the volume the nearest block serves:
// what is inside is no farther from it.

/// Looks in the middle, to both sides.
bool isFree(Ray ray, Segment segment, float first, float last) {
    float reach = 0.5 * (last - first) * ray.layerLength;
    float least = min(fma(reach, skipMap.w, 1.0), 255.0); // the greatest count there is
    // A lone sample is free where its block is.
    return countIsAbove(ivec3(blocksAt(ray, segment, 0.5 * (first + last))),
                        first < last ? uint(least) : 0u);
}

/// From a sample on: the rest of its block, and its free length.
float freeThrough(Ray ray, Segment segment, float first) {
    vec3 place = blocksAt(ray, segment, first);
    ivec3 block = ivec3(place);
    float count = float(freeCount(block));
    float within = (count - 1.0) / (skipMap.w * ray.layerLength);
    float inBlock = layersAhead(ray, place, vec3(block) + 0.5, vec3(0.5));
    return freeWhere(count > 0.0, first, max(inBlock, within));
}

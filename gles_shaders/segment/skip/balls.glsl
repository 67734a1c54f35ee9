// Proximity clouds (Tukora 2020, section 2.3): 0 where something visible may be met, else 1 + the
// free distance around any point of the block; skipMap.w counts go to a spacing of the lattice. See
// core/skip/proximity_cloud.h.
#include "segment/skip/blocks.glsl"
#include "segment/skip/grid.glsl"

// A look is in the middle: samples strictly within the free length are free, to both sides. Outside
// of the volume the nearest block serves: what is inside is no farther from it.

bool isFree(Ray ray, Segment segment, float first, float last) {
    float reach = 0.5 * (last - first) * ray.layerLength;
    float least = min(fma(reach, skipMap.w, 1.0), 255.0); // the greatest count there is
    // A lone sample is free where its block is.
    return countIsAbove(ivec3(blocksAt(ray, segment, 0.5 * (first + last))),
                        first < last ? uint(least) : 0u);
}

float freeThrough(Ray ray, Segment segment, float first, float last) {
    float middle = 0.5 * (first + last);
    float count = float(freeCount(ivec3(blocksAt(ray, segment, middle))));
    float reach = (count - 1.0) / (skipMap.w * ray.layerLength);
    return freeWhere(reach > middle - first, middle + reach);
}

// Proximity clouds (Tukora 2020, section 2.3): 0 where something visible may be met, else 1 + the
// free distance around any point of the block in units of skipMap.w. See
// core/skip/proximity_cloud.h.
#include "segment/skip/box.glsl"
#include "segment/skip/grid.glsl"

/// Samples strictly within the free length, and at least the one it is counted from.
int samplesWithin(int count, Ray ray) {
    return int(ceil(float(count - 1) * skipMap.w * kBelow / ray.layerLengthMm));
}

/// One fetch in the segment's middle proves all of it empty, where the free length reaches both
/// ends.
bool segmentIsEmpty(Ray ray, ivec2 range) {
    int last = range.y - 1 + kSharedEnds; // sample
    int middle = (range.x + last) / 2;
    int count = freeCount(blockAt(samplePosition(ray, middle) * skipMap.xyz));
    int reach = max(middle - range.x, last - middle);
    return count > 0 && max(1, samplesWithin(count, ray)) > reach;
}

/// What one fetch decides: all layers that begin within the block, free or not, and those within
/// its free length. Blocks are tested with a voxel's margin, so rounding at their faces does not
/// matter.
Stretch stretchAt(vec3 uvw, Ray ray) {
    vec3 position = uvw * skipMap.xyz;
    int count = freeCount(blockAt(position));
    vec3 ahead = vec3(greaterThan(ray.step, vec3(0.0))) - (position - floor(position));
    vec3 toFace = abs(ahead * ray.inverseStep / skipMap.xyz);
    int inBlock = int(min(min(toFace.x, min(toFace.y, toFace.z)), 1.0e6)) + 1;
    return stretchOf(count > 0 ? max(inBlock, samplesWithin(count, ray)) : inBlock, count > 0);
}

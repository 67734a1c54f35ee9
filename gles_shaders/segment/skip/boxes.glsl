// Free lengths in blocks (Deakin and Knackstedt 2019): 0 where something visible may be met, else
// the block is free when grown by one block less than the count. Counts of 0 and 1 are plain block
// occupancy.
#include "segment/skip/box.glsl"
#include "segment/skip/grid.glsl"

Box grownBlock(ivec3 block, int count) {
    int grown = max(count - 1, 0);
    return Box(vec3(block - grown), vec3(block + 1 + grown));
}

/// The box in the segment's middle proves all of it empty, where it holds both ends.
bool segmentIsEmpty(Ray ray, ivec2 range) {
    int last = range.y - 1 + kSharedEnds; // sample
    ivec3 middle = blockAt(samplePosition(ray, (range.x + last) / 2) * skipMap.xyz);
    int count = freeCount(middle);
    Box box = grownBlock(middle, count);
    vec3 inside = vec3(skipBlocks.xyz + 1);
    vec3 a = clamp(samplePosition(ray, range.x) * skipMap.xyz, vec3(0.0), inside);
    vec3 b = clamp(samplePosition(ray, last) * skipMap.xyz, vec3(0.0), inside);
    return count > 0 && all(greaterThanEqual(min(a, b), box.low)) &&
           all(lessThanEqual(max(a, b), box.high));
}

Stretch stretchAt(vec3 uvw, Ray ray) {
    vec3 position = uvw * skipMap.xyz;
    ivec3 block = blockAt(position);
    int count = freeCount(block);
    return stretchOf(samplesInBox(grownBlock(block, count), position, ray), count > 0);
}

// Free lengths in blocks (Deakin and Knackstedt 2019): 0 where something visible may be met, else
// the block is free when grown by one block less than the count. Counts of 0 and 1 are plain block
// occupancy.
#include "segment/skip/faces.glsl"
#include "segment/skip/grid.glsl"

/// Blocks around the one in the middle that hold all samples: what a free count must be above.
float blocksNeeded(Ray ray, Segment segment, float first, float last, vec3 centre) {
    vec3 a = abs(blocksAt(ray, segment, first) - centre);
    vec3 b = abs(blocksAt(ray, segment, last) - centre);
    vec3 most = max(a, b);
    return max(most.x, max(most.y, most.z)) - 0.5;
}

bool isFree(Ray ray, Segment segment, float first, float last) {
    ivec3 block = ivec3(blocksAt(ray, segment, 0.5 * (first + last)));
    float needed = blocksNeeded(ray, segment, first, last, vec3(block) + 0.5);
    return countIsAbove(block, uint(min(ceil(needed), 255.0)));
}

float freeThrough(Ray ray, Segment segment, float first) {
    vec3 place = blocksAt(ray, segment, first);
    ivec3 block = ivec3(place);
    float count = float(freeCount(block));
    return freeWhere(count > 0.0, first,
                     layersAhead(ray, place, vec3(block) + 0.5, vec3(count - 0.5)));
}

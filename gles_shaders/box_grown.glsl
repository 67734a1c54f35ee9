// Free lengths in blocks (Deakin and Knackstedt 2019): 0 where something visible may be met, else
// the block is free when grown by one block less than the count. Counts of 0 and 1 are plain block
// occupancy.
#include "skip_grid.glsl"

Box boxAt(vec3 position) {
    ivec3 block = blockAt(position);
    int count = freeCount(block);
    int grown = max(count - 1, 0);
    return Box(vec3(block - grown), vec3(block + 1 + grown), count > 0);
}

// Squared Euclidean lengths in integers, from box to box: blocks side by side have no gap. See
// core/skip/proximity_cloud.h.
const int kFar = 65024;            // 254 quanta of 256 units
const uint kFarSquared = 4228120576u;

uint squaredGap(int gap, int unitsPerBlock) {
    int units = gap > 254 ? kFar : min(gap * unitsPerBlock, kFar);
    return uint(units) * uint(units);
}

uvec4 sumUpToFar(uvec4 a, uint b) {
    return min(a, kFarSquared - b) + b; // more than far fits no word
}

uvec4 squaresAt(ivec3 at);

/// The least over a line's blocks of the square there and that of the gap. So far beyond that the
/// gap alone is no less, nothing is looked at.
uvec4 leastAlongLine(ivec3 at, ivec3 step, int before, int after, int unitsPerBlock) {
    uvec4 least = squaresAt(at);
    for (int way = 1; way <= max(before, after); ++way) {
        uint gap = squaredGap(way - 1, unitsPerBlock);
        if (all(lessThanEqual(least, uvec4(gap)))) {
            break;
        }
        if (way <= before) {
            least = min(least, sumUpToFar(squaresAt(at - way * step), gap));
        }
        if (way <= after) {
            least = min(least, sumUpToFar(squaresAt(at + way * step), gap));
        }
    }
    return least;
}

// Proximity clouds (Tukora 2020, section 2.3), one byte per block: 0 where something visible may be met, else
// 1 + the free distance around any point of the block in units of skipMap.w. See core/skip/proximity_cloud.h.
uniform usampler3D freeLengths;

int freeCount(vec3 uvw) {
    ivec3 block = clamp(ivec3(uvw * skipMap.xyz), ivec3(0), skipBlocks.xyz);
    countSkipFetch();
    return int(texelFetch(freeLengths, block, 0).r);
}

/// One fetch in the segment's middle proves all of it empty, where the free length reaches both ends.
bool segmentIsEmpty(Ray ray, ivec2 range) {
    int middle = (range.x + range.y - 1) / 2;
    int reach = max(middle - range.x, range.y - 1 - middle);
    int n = freeCount(samplePosition(ray, middle));
    return n > 0 && (reach == 0 || float(n - 1) * skipMap.w * kBelow > float(reach) * ray.layerLengthMm);
}

int freeLayers(vec3 uvw, Ray ray) {
    int n = freeCount(uvw);
    return n == 0 ? 0 : max(1, int(ceil(float(n - 1) * skipMap.w * kBelow / ray.layerLengthMm)));
}

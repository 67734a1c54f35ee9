// A segment without a loop: the host writes REPEAT_LAYERS(X) as X(0) X(1) ... for the variant's length.
void compositeLayer(Ray ray, int i, int end, inout int next, inout vec4 sum) {
    if (i < end && i >= next && !terminated(sum.a)) {
        vec3 uvw = samplePosition(ray, i);
        int free = freeLayers(uvw, ray);
        next = i + free;
        if (free == 0) {
            countLayer();
            sum += (1.0 - sum.a) * classify(uvw, lengthInside(ray, i), ray);
        }
    }
}

vec4 march(Ray ray, ivec2 range) {
    vec4 sum = vec4(0.0);
    int next = range.x;
#define COMPOSITE_LAYER(k) compositeLayer(ray, range.x + k, range.y, next, sum);
    REPEAT_LAYERS(COMPOSITE_LAYER)
    return sum;
}

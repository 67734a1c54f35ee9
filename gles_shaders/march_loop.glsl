// A segment as a loop, for desktop-class GPUs and lengths beyond the unroll list. Leaping and sampling are loops of
// their own, so that neighbouring fragments leap together and then sample together.
vec4 march(Ray ray, ivec2 range) {
    vec4 sum = vec4(0.0);
    int i = range.x;
    while (i < range.y) {
        vec3 uvw = samplePosition(ray, i);
        int free = freeLayers(uvw, ray);
        while (free > 0 && i + free < range.y) {
            i += free;
            uvw = samplePosition(ray, i);
            free = freeLayers(uvw, ray);
        }
        if (free > 0) {
            break;
        }
        countLayer();
        sum += (1.0 - sum.a) * classify(uvw, lengthInside(ray, i), ray);
        if (terminated(sum.a)) {
            break;
        }
        ++i;
    }
    return sum;
}

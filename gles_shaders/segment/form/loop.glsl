// A segment as a loop, for desktop-class GPUs and lengths beyond the unroll list. Leaping and
// sampling are loops of their own, so that neighbouring fragments leap together and then sample
// together.
vec4 march(Ray ray, ivec2 range) {
    vec4 sum = started();
    int i = range.x;
    while (i < range.y) {
        Stretch stretch = stretchAt(samplePosition(ray, i), ray);
        while (stretch.free && i + stretch.layers < range.y) {
            i += stretch.layers;
            stretch = stretchAt(samplePosition(ray, i), ray);
        }
        if (stretch.free) {
            break;
        }
        int stop = min(i + stretch.layers, range.y);
        beginRun(ray, i);
        for (; i < stop && !done(sum); ++i) {
            countLayer();
            sum = added(sum, classify(samplePosition(ray, i), ray, i));
        }
        if (done(sum)) {
            break;
        }
    }
    return resultOf(sum, i < range.y);
}

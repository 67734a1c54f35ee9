// A segment without a loop: the host writes REPEAT_LAYERS(X) as X(0) X(1) ... for the variant's
// length.
struct Walk {
    int decided; // layers before this one are known to be free or not
    bool free;
    bool left; // early
    vec4 sum;
};

void compositeLayer(Ray ray, int i, int end, inout Walk walk) {
    if (i >= end) {
        return;
    }
    if (done(walk.sum)) {
        walk.left = true;
        return;
    }
    vec3 uvw = samplePosition(ray, i);
    if (i >= walk.decided) {
        Stretch stretch = stretchAt(uvw, ray);
        walk.decided = i + stretch.layers;
        walk.free = stretch.free && stretch.layers > 0;
    }
    if (!walk.free) {
        countLayer();
        beginRun(ray, i);
        walk.sum = added(walk.sum, classify(uvw, ray, i));
    }
}

vec4 march(Ray ray, ivec2 range) {
    Walk walk = Walk(range.x, false, false, started());
#define COMPOSITE_LAYER(k) compositeLayer(ray, range.x + k, range.y, walk);
    REPEAT_LAYERS(COMPOSITE_LAYER)
    return resultOf(walk.sum, walk.left);
}

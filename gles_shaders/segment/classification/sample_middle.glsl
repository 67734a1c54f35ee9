// A layer is one sample, in its middle.
const int kSharedEnds = 0; // samples that neighbouring layers have in common

/// Sample of layer i: a pure function of ray and index, so that no way of walking moves it.
vec3 samplePosition(Ray ray, int i) {
    precise vec3 position = ray.centre + (float(i) - centre0.w + 0.5) * ray.step;
    return position;
}

void beginRun(Ray ray, int i) {}

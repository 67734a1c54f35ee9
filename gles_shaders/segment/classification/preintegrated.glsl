// Pre-integrated classification: a layer is the interval between two samples, along which the field
// is taken to run linearly. L layers take L + 1 samples. See core/transfer/preintegrated.h.
#include FIELD_FILE
precision highp sampler2D;
uniform sampler2D transferTable;
const int kSharedEnds = 1; // samples that neighbouring layers have in common

int sampledEnd = -1; // of which layer's front endTexel is
float endTexel;

/// Front of layer i, inside the box: a pure function of ray and index, so that no way of walking
/// moves it.
vec3 samplePosition(Ray ray, int i) {
    precise float offset = clamp(float(i) - centre0.w, ray.entry, ray.exit);
    precise vec3 position = ray.centre + offset * ray.step;
    return position;
}

/// Where the front of layer i lies along an axis of the table, beyond its ends too.
float texelAt(Ray ray, int i) {
    countFetches(kFetchesPerSample);
    precise float at = (sampleField(samplePosition(ray, i)) - tableMap.y) * tableMap.x;
    return clamp(at, -1.0e18, 1.0e18);
}

void beginRun(Ray ray, int i) {
    if (sampledEnd != i) {
        endTexel = texelAt(ray, i);
    }
}

/// Mean of an interval by the table, and by its ends where the TF is constant beyond them.
vec4 meanBetween(float front, float back) {
    float last = tableMap.w;
    vec2 place = clamp(vec2(front, back), 0.0, last);
    vec4 within = textureLod(transferTable, (place + 0.5) / (last + 1.0), 0.0);
    float low = min(front, back);
    float high = max(front, back);
    float below = max(min(high, 0.0) - low, 0.0);
    float above = max(high - max(low, last), 0.0);
    precise vec4 mean = (within * abs(place.y - place.x) + tableEnds[0] * below +
                         tableEnds[1] * above) / (high - low);
    // Beyond an end exactly that end's texel: the filter's weights could let its neighbour in.
    vec4 same = low >= last ? tableEnds[1] : high <= 0.0 ? tableEnds[0] : within;
    return low < high ? mean : same;
}

vec4 classify(vec3 uvw, Ray ray, int i) {
    float front = endTexel;
    endTexel = texelAt(ray, i + 1);
    sampledEnd = i + 1;
    vec4 mean = meanBetween(front, endTexel);
    float alpha = opacityOfDepth(mean.a * (lengthInside(ray, i) * tableMap.z));
    if (alpha == 0.0) {
        return vec4(0.0);
    }
    precise vec3 colour = mean.rgb * (alpha / mean.a);
    return vec4(colour, alpha);
}

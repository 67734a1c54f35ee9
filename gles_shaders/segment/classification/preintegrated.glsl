// Pre-integrated classification: a layer is the interval between two samples, along which the field
// is taken to run linearly. L layers take L + 1 samples. See core/transfer/preintegrated.h.
#include FIELD_FILE
#include "segment/classification/one_material.glsl"
#include MATERIAL_OF_INTERVAL_FILE
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

vec4 classify(vec3 uvw, Ray ray, int i) {
    float front = endTexel;
    endTexel = texelAt(ray, i + 1);
    sampledEnd = i + 1;
    vec4 mean = meanBetween(front, endTexel, kLabel, kSide);
    float alpha = opacityOfDepth(mean.a * (lengthInside(ray, i) * tableMap.z));
    if (alpha == 0.0) {
        return vec4(0.0);
    }
    precise vec3 colour = mean.rgb * (alpha / mean.a);
    return vec4(colour, alpha);
}

// Layers are all of one length, whose opacity texels hold. Whole ones are taken as they are; those
// at the ends of a ray's stay are weighed by 1 - (1 - a)^part, once for a segment.
#include "segment/lengths/opacity.glsl"
#include "segment/lengths/of_opacity.glsl"

float fullLight(vec4 layer) {
    return layer.a;
}

/// partInside() of whole layers is 0 or 1.
void addLayer(inout Sum sum, inout float front, Ray ray, Segment segment, float k) {
    addShare(sum, layerAt(ray, segment, k, front), partInside(segment, k));
}

/// The layers that groups add.
Segment composited(Segment segment) {
    return wholeLayers(segment);
}

float layersInGroups(Segment segment);
float layersOf(Segment segment) {
    return layersInGroups(composited(segment)) + step(0.0, cutAtEntry(segment)) +
           step(0.0, cutAtExit(segment));
}

void addCut(inout Sum sum, Ray ray, Segment segment, float k) {
    if (k >= 0.0 && !done(sum)) {
        float front = 0.0;
        countLayers(1);
        add(sum, ofLength(layerAt(ray, segment, k, front), partInside(segment, k)));
    }
}

void addEntry(inout Sum sum, Ray ray, Segment segment) {
    addCut(sum, ray, segment, cutAtEntry(segment));
}

void addExit(inout Sum sum, Ray ray, Segment segment) {
    addCut(sum, ray, segment, cutAtExit(segment));
}

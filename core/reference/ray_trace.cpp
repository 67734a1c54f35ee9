#include "core/reference/ray_trace.h"

#include <algorithm>
#include <cmath>

#include "core/reference/cell_walk.h"
#include "core/reference/emission_integral.h"
#include "core/reference/material.h"
#include "core/reference/stretches.h"
#include "core/volume/trilinear_field.h"

namespace slabcast {

namespace {

/// The exact integral along a ray, gathered a part at a time, front to back.
template <class Field>
class ExactParts {
public:
    ExactParts(const TraceInput& input, const Field& field, const LatticeRay& ray)
        : field_(field), ray_(ray), dims_(input.texels->dims), ramps_(input.tf, input.space),
          integral_(input.tf.opacityUnitMm, input.space, input.tolerance) {}

    /// Goes on between two offsets.
    glm::dvec4 add(double from, double to) {
        LatticeRay part = ray_;
        part.entry = from;
        part.exit = to;
        walkCells(
            part, dims_, [&](glm::ivec3 cell, glm::dvec3 begin, glm::dvec3 end, double layers) {
                visitStretches(fieldAlong(field_.cornersOf(cell), begin, end), ramps_,
                               [&](const TransferRamp& ramp, const Cubic& share, double of) {
                                   integral_.add(ramp, share, of * layers * ray_.layerLengthMm);
                               });
                return !integral_.isOpaque();
            });
        return integral_.premultiplied();
    }

private:
    const Field& field_;
    const LatticeRay& ray_;
    glm::ivec3 dims_;
    TransferRamps ramps_;
    EmissionIntegral integral_;
};

template <class Field>
std::vector<TracedLayer> layersAlong(const TraceInput& input, const Field& field,
                                     const LatticeRay& ray, glm::dvec3 eyeMm) {
    const glm::dmat4 modelFromUvw = input.geometry.modelFromUvw();
    const int total = input.lattice.total;
    const LayerRange range = layersOf(ray, total);
    ExactParts<Field> exact(input, field, ray);
    std::vector<TracedLayer> layers;
    glm::dvec4 gathered(0.0);
    for (int i = range.begin; i < range.end; ++i) {
        const glm::dvec3 uvw = samplePosition(ray, total, i);
        TracedLayer layer{.index = i,
                          .placeMm = glm::dvec3(modelFromUvw * glm::dvec4(uvw, 1.0)),
                          .lengthMm = layerWeight(ray, total, i) * ray.layerLengthMm,
                          .value = field.at(uvw)};
        const glm::dvec4 material = materialOf(input.tf, input.space, layer.value);
        layer.distanceMm = glm::distance(layer.placeMm, eyeMm);
        layer.color = glm::dvec3(material);
        layer.opacity = -std::expm1(-material.w * input.tf.opacityUnitMm);
        layer.alpha = -std::expm1(-material.w * layer.lengthMm);
        gathered += (1.0 - gathered.w) * glm::dvec4(layer.color * layer.alpha, layer.alpha);
        layer.gathered = gathered;
        const double front = i - total / 2.0;
        layer.exact = exact.add(std::clamp(front, ray.entry, ray.exit),
                                std::clamp(front + 1.0, ray.entry, ray.exit));
        layers.push_back(layer);
    }
    return layers;
}

} // namespace

RayTrace traceRay(const TraceInput& input, glm::dvec2 fragCoord) {
    SLABCAST_EXPECTS(input.texels != nullptr && !input.texels->data.empty(), 0);
    const LatticeRay ray =
        rayAt(makeRayFrame(input.view, input.viewport, input.geometry, input.lattice), fragCoord);
    const glm::dmat4 modelFromUvw = input.geometry.modelFromUvw();
    const auto placeAt = [&](double offset) {
        return glm::dvec3(modelFromUvw * glm::dvec4(ray.centre + offset * ray.step, 1.0));
    };
    RayTrace trace;
    trace.eyeMm = glm::dvec3(glm::inverse(glm::dmat4(input.view.viewFromModel))[3]);
    trace.direction = glm::normalize(glm::dmat3(modelFromUvw) * ray.step);
    if (ray.entry < ray.exit) {
        trace.entryMm = glm::distance(placeAt(ray.entry), trace.eyeMm);
        trace.exitMm = glm::distance(placeAt(ray.exit), trace.eyeMm);
    }
    trace.layers = visitTexelFormat(input.texels->format, [&](auto codec) {
        return layersAlong(input, TrilinearField(*input.texels, codec), ray, trace.eyeMm);
    });
    return trace;
}

} // namespace slabcast

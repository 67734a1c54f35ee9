#include "perf/stability/perturbed_inputs.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace slabcast::stability {

namespace {

constexpr std::size_t kPoint = 1; // the one that is changed

/// Points of the transfer function at the changed one's value: two where that is a step.
struct Step {
    std::size_t first, last;
};
Step pointsOf(const TransferFunction& tf) {
    const bool two = tf.points[kPoint + 1].value == tf.points[kPoint].value;
    return {kPoint, two ? kPoint + 1 : kPoint};
}

/// The ramp beside the changed point on which a value lies, from the point outwards.
struct Side {
    double share = 0.0; // 1 at the point, 0 at the next one
    double opacitySlope = 0.0;
    double colorSlope = 0.0;
    bool above = false;
};
Side sideOf(const TransferFunction& tf, double value) {
    const Step at = pointsOf(tf);
    Side side{.above = value >= tf.points[at.first].value};
    const TransferPoint& near = tf.points[side.above ? at.last : at.first];
    const TransferPoint& far = tf.points[side.above ? at.last + 1 : at.first - 1];
    const double width = far.value - near.value;
    side.share = std::clamp(1.0 - (value - near.value) / width, 0.0, 1.0);
    side.opacitySlope = std::abs((far.opacity - near.opacity) / width);
    const glm::dvec3 rise = glm::abs(far.color - near.color);
    side.colorSlope = std::max({rise.x, rise.y, rise.z}) / std::abs(width);
    return side;
}

/// The upper point of a step, which rules values above it alone; any other rules both sides.
double shareOfUpper(const TransferFunction& tf, double value) {
    const Step at = pointsOf(tf);
    const Side side = sideOf(tf, value);
    return side.above || at.first == at.last ? side.share : 0.0;
}

TransferSlope byPointOpacity(const TransferFunction& tf, double value) {
    return {.opacity = tf.points[pointsOf(tf).last].opacity * shareOfUpper(tf, value)};
}
TransferSlope byPointColor(const TransferFunction& tf, double value) {
    const glm::dvec3 color = tf.points[pointsOf(tf).last].color;
    return {.color = std::max({color.x, color.y, color.z}) * shareOfUpper(tf, value)};
}
TransferSlope byUnit(const TransferFunction&, double) {
    return {.extinction = 1.0};
}
TransferSlope byPointValue(const TransferFunction& tf, double value) {
    const double at = tf.points[kPoint].value;
    const Side side = sideOf(tf, value);
    const Side other = sideOf(tf, 2.0 * at - value); // as steep, should the point pass the value
    return {.opacity =
                at * std::max(side.opacitySlope * side.share, other.opacitySlope * other.share),
            .color = at * std::max(side.colorSlope * side.share, other.colorSlope * other.share)};
}

double distanceOf(const SampleSetup& setup) {
    const glm::dvec4 centre(setup.geometry.boundingSphere().centreMm, 1.0);
    return glm::length(glm::dvec3(setup.view.viewFromModel * centre));
}

void moveEye(SampleSetup& setup, glm::dvec3 inView) {
    setup.view.viewFromModel =
        glm::translate(glm::dmat4(1.0), -inView * distanceOf(setup)) * setup.view.viewFromModel;
}

} // namespace

std::span<const Input> perturbedInputs() {
    static constexpr Input kInputs[] = {
        {"eye, across",
         [](SampleSetup& s, double share) {
             moveEye(s, {share, 0.0, 0.0});
         },
         nullptr, true},
        {"eye, forwards",
         [](SampleSetup& s, double share) {
             moveEye(s, {0.0, 0.0, -share});
         },
         nullptr, true},
        {"voxel spacing",
         [](SampleSetup& s, double share) { s.geometry.spacingMm.x *= 1.0 + share; }, nullptr,
         true},
        {"layer spacing", [](SampleSetup& s, double share) { s.lattice.spacingMm *= 1.0 + share; },
         nullptr, true},
        {"unit of opacity", [](SampleSetup& s, double share) { s.tf.opacityUnitMm *= 1.0 + share; },
         byUnit, false},
        {"opacity of a point",
         [](SampleSetup& s, double share) {
             s.tf.points[pointsOf(s.tf).last].opacity *= 1.0 + share;
         },
         byPointOpacity, false},
        {"colour of a point",
         [](SampleSetup& s, double share) {
             s.tf.points[pointsOf(s.tf).last].color *= 1.0 + share;
         },
         byPointColor, false},
        {"value of a point",
         [](SampleSetup& s, double share) {
             const Step at = pointsOf(s.tf);
             for (std::size_t i = at.first; i <= at.last; ++i) {
                 s.tf.points[i].value *= 1.0 + share;
             }
         },
         byPointValue, true}};
    return kInputs;
}

} // namespace slabcast::stability

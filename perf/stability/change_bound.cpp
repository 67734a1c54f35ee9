#include "perf/stability/change_bound.h"

#include <algorithm>
#include <cmath>

#include "core/volume/trilinear_field.h"

namespace slabcast::stability {

namespace {

/// Steepest difference along each axis between neighbours among a cell's corners.
glm::dvec3 steepestOf(const std::array<double, 8>& corner) {
    glm::dvec3 most(0.0);
    for (std::size_t k = 0; k < 8; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t other = k ^ (std::size_t{1} << axis);
            most[axis] = std::max(most[axis], std::abs(corner[k] - corner[other]));
        }
    }
    return most;
}

double largestOf(glm::dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

} // namespace

std::vector<glm::dvec4> samplesOf(const SampleSetup& setup, glm::ivec2 size) {
    return renderDiscrete({.texels = setup.texels,
                           .geometry = setup.geometry,
                           .transfer = setup.tf,
                           .view = setup.view,
                           .viewport = {0, 0, size.x, size.y},
                           .lattice = setup.lattice});
}

ChangeBound::ChangeBound(const SampleSetup& before, const SampleSetup& after, glm::ivec2 size,
                         double relative, TransferSlopes slopes)
    : before_(before), after_(after), frameBefore_(makeRayFrame(before.view, {0, 0, size.x, size.y},
                                                                before.geometry, before.lattice)),
      frameAfter_(makeRayFrame(after.view, {0, 0, size.x, size.y}, after.geometry, after.lattice)),
      relative_(relative), slopes_(std::move(slopes)) {
    visitTexelFormat(before.texels->format, [&](auto codec) {
        const TrilinearField field(*before.texels, codec);
        field_ = [field](glm::dvec3 uvw) { return field.at(uvw); };
        corners_ = [field](glm::ivec3 cell) { return field.cornersOf(cell); };
    });
}

double ChangeBound::valueChange(glm::dvec3 from, glm::dvec3 to) const {
    const glm::dvec3 dims(before_.geometry.dims);
    const auto cellAt = [&](glm::dvec3 uvw) { return glm::ivec3(glm::floor(uvw * dims - 0.5)); };
    const glm::dvec3 most =
        glm::max(steepestOf(corners_(cellAt(from))), steepestOf(corners_(cellAt(to))));
    return glm::dot(most, glm::abs(to - from) * dims);
}

glm::dvec2 ChangeBound::steepest(double low, double high) const {
    glm::dvec2 most(0.0);
    for (const TransferFunction* tf : {&before_.tf, &after_.tf}) {
        for (std::size_t i = 0; i + 1 < tf->points.size(); ++i) {
            const TransferPoint& a = tf->points[i];
            const TransferPoint& b = tf->points[i + 1];
            if (a.value < b.value && a.value <= high && b.value >= low) {
                const glm::dvec2 rise(std::abs(b.opacity - a.opacity),
                                      largestOf(glm::abs(b.color - a.color)));
                most = glm::max(most, rise / (b.value - a.value));
            }
        }
    }
    return most;
}

bool ChangeBound::mayPassStep(double value, double change) const {
    const auto& points = before_.tf.points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double at = points[i].value;
        if (at != points[i + 1].value) {
            continue;
        }
        const double moved = after_.tf.points[i].value;
        const bool beyond = value >= at;
        if (beyond ? value - change < moved : value + change >= moved) {
            return true;
        }
    }
    return false;
}

PixelChange ChangeBound::at(glm::dvec2 fragCoord) const {
    const LatticeRay before = rayAt(frameBefore_, fragCoord);
    const LatticeRay after = rayAt(frameAfter_, fragCoord);
    const int total = before_.lattice.total;
    const double unit = before_.tf.opacityUnitMm;
    PixelChange result;
    double clear = 1.0;
    for (int i = 0; i < total; ++i) {
        const double length = layerWeight(before, total, i) * before.layerLengthMm;
        const double lengthAfter = layerWeight(after, total, i) * after.layerLengthMm;
        if (length == 0.0 && lengthAfter == 0.0) {
            continue;
        }
        result.covered = true;
        const glm::dvec3 uvw = samplePosition(before, total, i);
        const double value = field_(uvw);
        const double change = valueChange(uvw, samplePosition(after, total, i));
        result.meetsStep |= mayPassStep(value, change);
        const glm::dvec2 slope = steepest(value - change, value + change);
        const TransferSlope own = slopes_ ? slopes_(before_.tf, value) : TransferSlope{};
        const double opacity = evaluate(before_.tf, value).opacity;
        const double ofOpacity = slope.x * change + own.opacity * relative_;
        const double ofColor = slope.y * change + own.color * relative_;
        const auto extinction = [&](double o, double share) {
            return extinctionPerMm(std::clamp(o, 0.0, kMaxOpacity), unit) * (1.0 + share);
        };
        const double share = own.extinction * relative_;
        const auto alphaOf = [](double sigma, double mm) { return -std::expm1(-sigma * mm); };
        const double alpha = alphaOf(extinction(opacity, 0.0), length);
        const double least =
            alphaOf(extinction(opacity - ofOpacity, -share), std::min(length, lengthAfter));
        const double most =
            alphaOf(extinction(opacity + ofOpacity, share), std::max(length, lengthAfter));
        result.bound += clear * (std::max(most - alpha, alpha - least) + most * ofColor);
        clear *= 1.0 - least;
    }
    return result;
}

} // namespace slabcast::stability

#include "core/reference/transfer_ramps.h"

#include <algorithm>
#include <limits>

namespace slabcast {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSrgbJoint = 0.04045; // IEC 61966-2-1: linear below, a power above

TransferSample sampleOf(const TransferPoint& point) {
    return {point.color, point.opacity};
}

/// Where between two points, in (0, 1), a channel passes the joint; ascending.
std::vector<double> jointsBetween(glm::dvec3 low, glm::dvec3 high) {
    std::vector<double> joints;
    for (int channel = 0; channel < 3; ++channel) {
        const double share = (kSrgbJoint - low[channel]) / (high[channel] - low[channel]);
        if (share > 0.0 && share < 1.0) { // false for NaN: the channel is constant
            joints.push_back(share);
        }
    }
    std::sort(joints.begin(), joints.end());
    return joints;
}

TransferPoint between(const TransferPoint& a, const TransferPoint& b, double share) {
    return {.value = std::clamp(glm::mix(a.value, b.value, share), a.value, b.value),
            .color = glm::mix(a.color, b.color, share),
            .opacity = glm::mix(a.opacity, b.opacity, share)};
}

std::vector<TransferPoint> knotsOf(const TransferFunction& tf, CompositingSpace space) {
    if (space == CompositingSpace::Display) {
        return tf.points;
    }
    std::vector<TransferPoint> knots;
    for (const TransferPoint& point : tf.points) {
        if (!knots.empty() && knots.back().value < point.value) {
            const TransferPoint last = knots.back();
            for (const double share : jointsBetween(last.color, point.color)) {
                knots.push_back(between(last, point, share));
            }
        }
        knots.push_back(point);
    }
    return knots;
}

} // namespace

TransferRamps::TransferRamps(const TransferFunction& tf, CompositingSpace space) {
    SLABCAST_EXPECTS(!tf.points.empty(), tf.points.size());
    const std::vector<TransferPoint> knots = knotsOf(tf, space);
    TransferPoint before = knots.front();
    before.value = -kInfinity;
    const auto rampTo = [&](double highValue, const TransferSample& high) {
        if (before.value < highValue) {
            ramps_.push_back({before.value, highValue, sampleOf(before), high});
        }
    };
    for (const TransferPoint& knot : knots) {
        rampTo(knot.value, sampleOf(knot));
        before = knot;
    }
    rampTo(kInfinity, sampleOf(before));
    visibleBefore_ = {0};
    for (const TransferRamp& ramp : ramps_) {
        bounds_.push_back(ramp.highValue);
        visibleBefore_.push_back(visibleBefore_.back() + (ramp.isEmpty() ? 0 : 1));
    }
    bounds_.pop_back(); // infinity bounds nothing
}

int TransferRamps::holding(double base, double above) const {
    const auto bound =
        std::upper_bound(bounds_.begin(), bounds_.end(), above,
                         [base](double value, double b) { return value < b - base; });
    return static_cast<int>(bound - bounds_.begin());
}

int TransferRamps::endingAt(double base, double above) const {
    const auto bound =
        std::lower_bound(bounds_.begin(), bounds_.end(), above,
                         [base](double b, double value) { return b - base < value; });
    return static_cast<int>(bound - bounds_.begin());
}

bool TransferRamps::anyVisible(int first, int last) const {
    return visibleBefore_[static_cast<std::size_t>(last) + 1] >
           visibleBefore_[static_cast<std::size_t>(first)];
}

} // namespace slabcast

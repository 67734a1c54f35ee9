#pragma once

#include <algorithm>

#include "core/reference/field_cubic.h"
#include "core/reference/transfer_ramps.h"

namespace slabcast {

namespace detail {

/// How far from the ramp's fainter end the part of the field lies. A ramp without bounds is
/// uniform: anywhere.
inline Cubic shareOfRamp(const TransferRamp& ramp, const FieldCubic& field, double begin,
                         double end) {
    if (ramp.isUniform()) {
        return {};
    }
    const double faint = ramp.isFalling() ? ramp.highValue : ramp.lowValue;
    const double dense = ramp.isFalling() ? ramp.lowValue : ramp.highValue;
    Cubic share = field.above.part(begin, end);
    for (double& point : share.points) {
        point = (point - (faint - field.base)) / (dense - faint);
    }
    return share;
}

template <class Visit>
void visitMonotone(const FieldCubic& field, const TransferRamps& ramps, double begin, double end,
                   const Visit& visit) {
    const double first = field.above.at(begin);
    const double last = field.above.at(end);
    const bool rises = last > first;
    const int lowest = ramps.holding(field.base, std::min(first, last));
    const int highest = std::max(lowest, ramps.endingAt(field.base, std::max(first, last)));
    const int finish = rises ? highest : lowest;
    for (int at = rises ? lowest : highest; begin < end; at += rises ? 1 : -1) {
        const TransferRamp& ramp = ramps[at];
        const double knot = rises ? ramp.highValue : ramp.lowValue;
        const double cut =
            at == finish ? end : crossingOf(field.above, knot - field.base, begin, end);
        if (!ramp.isEmpty() && cut > begin) {
            visit(ramp, shareOfRamp(ramp, field, begin, cut), cut - begin);
        }
        if (at == finish) {
            return;
        }
        begin = cut;
    }
}

} // namespace detail

/// Cuts the field along a ray's way through a cell where it crosses from one ramp of the TF to the
/// next, and visits, front to back, what is not empty as visit(ramp, share, part): how far from the
/// ramp's fainter end the field lies, as a cubic over the stretch, and the stretch's part of the
/// way. Tested by: field_cubic_test.cpp
template <class Visit>
void visitStretches(const FieldCubic& field, const TransferRamps& ramps, const Visit& visit) {
    const auto [low, high] =
        std::minmax_element(field.above.points.begin(), field.above.points.end());
    const int lowest = ramps.holding(field.base, *low);
    const int highest = std::max(lowest, ramps.endingAt(field.base, *high));
    if (!ramps.anyVisible(lowest, highest)) {
        return;
    }
    if (lowest == highest) {
        visit(ramps[lowest], detail::shareOfRamp(ramps[lowest], field, 0.0, 1.0), 1.0);
        return;
    }
    const Turns turns = turnsOf(field.above);
    double begin = 0.0;
    for (int k = 0; k <= turns.count; ++k) {
        const double end = k < turns.count ? turns.at[static_cast<std::size_t>(k)] : 1.0;
        detail::visitMonotone(field, ramps, begin, end, visit);
        begin = end;
    }
}

} // namespace slabcast

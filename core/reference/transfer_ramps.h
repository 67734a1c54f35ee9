#pragma once

#include <vector>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// One stretch of values over which a TF is smooth: opacity and encoded colour are linear from
/// `low`, the limit at lowValue, to `high`. Before the first point and after the last one it is
/// unbounded and constant.
struct TransferRamp {
    double lowValue = 0.0;
    double highValue = 0.0;
    TransferSample low;
    TransferSample high;

    bool isEmpty() const { return low.opacity == 0.0 && high.opacity == 0.0; }
    bool isUniform() const { return low.opacity == high.opacity && low.color == high.color; }

    // Measured from its fainter end an opacity near zero keeps all its digits.
    bool isFalling() const { return high.opacity < low.opacity; }
    const TransferSample& faint() const { return isFalling() ? high : low; }
    const TransferSample& dense() const { return isFalling() ? low : high; }
};

/// A TF as consecutive ramps. Steps lie between two of them; in linear space they also end where a
/// channel passes the joint of the sRGB curve, so that the composited colour is smooth too.
/// Values are given as base + above: what lies near the base is told apart although its sum with
/// the base would be rounded.
/// Tested by: transfer_ramps_test.cpp
class TransferRamps {
public:
    TransferRamps(const TransferFunction& tf, CompositingSpace space);

    int count() const { return static_cast<int>(ramps_.size()); }
    const TransferRamp& operator[](int ramp) const {
        return ramps_[static_cast<std::size_t>(ramp)];
    }
    /// The ramp that holds a value; of two that meet there, the upper one.
    int holding(double base, double above = 0.0) const;
    /// As holding(), but of two that meet there the lower one.
    int endingAt(double base, double above = 0.0) const;
    /// Of the ramps from first to last, both included.
    bool anyVisible(int first, int last) const;

private:
    std::vector<TransferRamp> ramps_;
    std::vector<double> bounds_;     // bounds_[i] between ramps i and i + 1, ascending
    std::vector<int> visibleBefore_; // of the ramps below i
};

} // namespace slabcast

#pragma once

#include <span>

#include "perf/median_interval.h"

namespace slabcast {

/// How many times as long one takes as the other.
struct PairedRatio {
    double median = 0.0;
    MedianInterval interval;
};

/// Median of a[k] / b[k], with its interval: what makes both slower in one round, as a busy machine
/// or another view does, is in neither. Contract: as many of the one as of the other, one at least.
/// Tested by: paired_ratio_test.cpp
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b);

} // namespace slabcast

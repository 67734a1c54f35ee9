#pragma once

#include <vector>

namespace slabcast {

/// Where the median of what samples were drawn from lies, and how sure that is.
struct MedianInterval {
    double low = 0.0, high = 0.0;
    double coverage = 0.0; // probability
};

inline constexpr double kMedianCoverage = 0.95;

/// The narrowest symmetric pair of order statistics that covers the median with kMedianCoverage at
/// least, whatever the distribution: between the k-th from below and the k-th from above lies the
/// median with 1 - 2 P(B < k), B binomial of n and 1/2. Of fewer than 6 samples no pair does: then
/// the least and the greatest, with the coverage that they have (5: 0.9375, 3: 0.75, 1: 0).
/// Contract: one sample at least; they are independent. Source: Hahn and Meeker 1991, section 5.2.
/// Tested by: median_interval_test.cpp
MedianInterval medianInterval(std::vector<double> samples);

} // namespace slabcast

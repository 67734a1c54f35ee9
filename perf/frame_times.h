#pragma once

#include <vector>

namespace slabcast {

inline constexpr int kFewestFrames = 3; // of a row: one slow frame is not the median

inline constexpr int kFewestForPercentiles = 9; // below, the 10th is the least or its neighbour

/// Of several frames, ms.
struct FrameTimes {
    double median = 0.0, min = 0.0, max = 0.0, p10 = 0.0, p90 = 0.0;
    int count = 0;
};

/// The median of an even number of times is the mean of the middle two; the percentiles are times
/// that were measured. All zero of none. Tested by: frame_times_test.cpp
FrameTimes summarise(std::vector<double> milliseconds);

} // namespace slabcast

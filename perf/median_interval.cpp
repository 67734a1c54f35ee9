#include "perf/median_interval.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace slabcast {

namespace {

/// P(B = k) of n tosses of a fair coin; by logarithms, as 2^-n may be no double.
double tosses(std::size_t n, std::size_t k) {
    const auto logFactorial = [](std::size_t m) {
        return std::lgamma(static_cast<double>(m) + 1.0);
    };
    return std::exp(logFactorial(n) - logFactorial(k) - logFactorial(n - k) -
                    static_cast<double>(n) * std::log(2.0));
}

} // namespace

MedianInterval medianInterval(std::vector<double> samples) {
    SLABCAST_EXPECTS(!samples.empty(), samples.size());
    std::sort(samples.begin(), samples.end());
    const std::size_t n = samples.size();
    std::size_t left = 0; // samples out on either side
    double outside = tosses(n, 0);
    double coverage = 1.0 - 2.0 * outside;
    while (2 * (left + 2) <= n) {
        const double next = outside + tosses(n, left + 1);
        if (1.0 - 2.0 * next < kMedianCoverage) {
            break;
        }
        outside = next;
        coverage = 1.0 - 2.0 * outside;
        ++left;
    }
    return {samples[left], samples[n - 1 - left], std::max(coverage, 0.0)};
}

} // namespace slabcast

#include "perf/paired_ratio.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "perf/frame_times.h"

namespace slabcast {

PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b) {
    SLABCAST_EXPECTS(a.size() == b.size(), b.size());
    std::vector<double> ratios(a.size());
    std::transform(a.begin(), a.end(), b.begin(), ratios.begin(),
                   [](double x, double y) { return x / y; });
    const double median = summarise(ratios).median;
    return {median, medianInterval(std::move(ratios))};
}

} // namespace slabcast

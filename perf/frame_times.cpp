#include "perf/frame_times.h"

#include <algorithm>
#include <cstddef>

namespace slabcast {

FrameTimes summarise(std::vector<double> ms) {
    if (ms.empty()) {
        return {};
    }
    std::sort(ms.begin(), ms.end());
    const auto at = [&ms](double quantile) {
        return ms[static_cast<std::size_t>(quantile * static_cast<double>(ms.size() - 1) + 0.5)];
    };
    const std::size_t middle = ms.size() / 2;
    const double median = ms.size() % 2 == 1 ? ms[middle] : 0.5 * (ms[middle - 1] + ms[middle]);
    return {median, ms.front(), ms.back(), at(0.1), at(0.9), static_cast<int>(ms.size())};
}

} // namespace slabcast

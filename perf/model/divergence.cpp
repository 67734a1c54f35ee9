#include "perf/model/divergence.h"

#include <algorithm>

#include "core/base/error.h"

namespace slabcast {

double divergence(std::span<const PixelWork> work, glm::ivec2 size, glm::ivec2 wave,
                  const std::function<double(const PixelWork&)>& amount) {
    SLABCAST_EXPECTS(work.size() == static_cast<std::size_t>(size.x) * std::size_t(size.y),
                     work.size());
    SLABCAST_EXPECTS(wave.x >= 1 && wave.y >= 1, wave.x);
    double asked = 0.0;
    double done = 0.0;
    for (int top = 0; top < size.y; top += wave.y) {
        for (int left = 0; left < size.x; left += wave.x) {
            double most = 0.0;
            for (int y = top; y < std::min(top + wave.y, size.y); ++y) {
                for (int x = left; x < std::min(left + wave.x, size.x); ++x) {
                    const double one = amount(
                        work[static_cast<std::size_t>(y) * std::size_t(size.x) + std::size_t(x)]);
                    asked += one;
                    most = std::max(most, one);
                }
            }
            done += most * wave.x * wave.y;
        }
    }
    return asked > 0.0 ? done / asked : 1.0;
}

} // namespace slabcast

#include "core/base/parallel.h"

#include <algorithm>
#include <thread>
#include <vector>

#include "core/base/error.h"

namespace slabcast {

bool parallelFor(std::int64_t count, std::int64_t grain,
                 const std::function<void(std::int64_t, std::int64_t)>& body,
                 const CancelToken* cancel) {
    SLABCAST_EXPECTS(grain > 0, grain);
    std::atomic<std::int64_t> next{0};
    std::atomic<bool> complete{true};
    const auto work = [&] {
        for (std::int64_t begin = next.fetch_add(grain); begin < count;
             begin = next.fetch_add(grain)) {
            if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) {
                complete = false;
                return;
            }
            body(begin, std::min(begin + grain, count));
        }
    };
    const std::int64_t ranges = (count + grain - 1) / grain;
    const std::int64_t cores = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::thread> helpers;
    for (std::int64_t i = 1; i < std::min(ranges, cores); ++i) {
        helpers.emplace_back(work);
    }
    work();
    for (std::thread& helper : helpers) {
        helper.join();
    }
    return complete;
}

} // namespace slabcast

#include "core/base/parallel.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/executor.h"

namespace slabcast {

bool parallelFor(std::int64_t count, std::int64_t grain,
                 FunctionRef<void(std::int64_t, std::int64_t)> body, const CancelToken* cancel) {
    SLABCAST_EXPECTS(grain > 0, grain);
    std::atomic<std::int64_t> next{0};
    std::atomic<bool> complete{true};
    const auto work = [&](int /*task*/) {
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
    Executor& threads = executor();
    threads.run(static_cast<int>(std::clamp<std::int64_t>(ranges, 1, threads.concurrency())), work);
    return complete;
}

} // namespace slabcast

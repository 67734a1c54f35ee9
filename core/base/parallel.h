#pragma once

#include <atomic>
#include <cstdint>

#include "core/base/function_ref.h"

namespace slabcast {

/// Set from any thread to make a long CPU step stop at its next item.
using CancelToken = std::atomic<bool>;

/// Calls `body(begin, end)` on disjoint ranges that cover [0, count), on all cores, and returns
/// when all are done: on executor(). Ranges hold about `grain` items and are handed out as threads
/// fall free, so uneven work balances itself. Once `cancel` is set no further range starts; returns
/// false then, else true. Cost: O(count/grain) hand-outs.
bool parallelFor(std::int64_t count, std::int64_t grain,
                 FunctionRef<void(std::int64_t begin, std::int64_t end)> body,
                 const CancelToken* cancel = nullptr);

} // namespace slabcast

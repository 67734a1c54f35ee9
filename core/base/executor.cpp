#include "core/base/executor.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "core/base/thread_pool.h"

namespace slabcast {

namespace {

std::atomic<Executor*> hosts{nullptr};

Executor& ownExecutor() {
    static ThreadPool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())) - 1);
    return pool;
}

} // namespace

Executor& executor() {
    Executor* const host = hosts.load();
    return host != nullptr ? *host : ownExecutor();
}

void setExecutor(Executor* host) {
    hosts.store(host);
}

} // namespace slabcast

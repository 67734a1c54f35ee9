#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/executor.h"

namespace slabcast {

/// Threads that are kept: none is started by run(), and nothing is allocated there. Tested by:
/// executor_test.cpp
class ThreadPool : public Executor {
public:
    /// So many threads beside the calling one; 0: all runs in the calling one.
    explicit ThreadPool(int helpers);
    ~ThreadPool() override;

    int concurrency() const override { return static_cast<int>(helpers_.size()) + 1; }
    void run(int count, FunctionRef<void(int)> task) override;

private:
    /// One call of run(), which waits in it until all is done.
    struct Job {
        FunctionRef<void(int)> task;
        int count;
        int begun = 0;
        int done = 0;
        Job* next = nullptr;
    };

    void help();
    /// Takes and runs one task of a job, the lock released meanwhile.
    void runNext(Job& job, std::unique_lock<std::mutex>& lock);
    Job* unbegun() const; // a job with tasks that nobody has taken
    void remove(const Job& job);

    std::mutex mutex_;
    std::condition_variable hasWork_; // for helpers
    std::condition_variable isDone_;  // for callers
    Job* jobs_ = nullptr;             // the last one begun first
    bool ending_ = false;
    std::vector<std::thread> helpers_;
};

} // namespace slabcast

#include "core/base/thread_pool.h"

namespace slabcast {

ThreadPool::ThreadPool(int helpers) {
    helpers_.reserve(static_cast<std::size_t>(helpers));
    for (int i = 0; i < helpers; ++i) {
        helpers_.emplace_back([this] { help(); });
    }
}

ThreadPool::~ThreadPool() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    hasWork_.notify_all();
    for (std::thread& helper : helpers_) {
        helper.join();
    }
}

// A caller waits only for tasks of its own that others have begun. Those end without it: they may
// wait for further calls that they made, never for one that waits for them.
void ThreadPool::run(int count, FunctionRef<void(int)> task) {
    if (count <= 1 || helpers_.empty()) {
        for (int i = 0; i < count; ++i) {
            task(i);
        }
        return;
    }
    Job job{task, count};
    std::unique_lock lock(mutex_);
    job.next = jobs_;
    jobs_ = &job;
    hasWork_.notify_all();
    while (job.begun < job.count) {
        runNext(job, lock);
    }
    isDone_.wait(lock, [&] { return job.done == job.count; });
    remove(job);
}

void ThreadPool::help() {
    std::unique_lock lock(mutex_);
    while (true) {
        hasWork_.wait(lock, [this] { return ending_ || unbegun() != nullptr; });
        Job* job = unbegun();
        if (job == nullptr) {
            return; // it ends
        }
        runNext(*job, lock);
    }
}

void ThreadPool::runNext(Job& job, std::unique_lock<std::mutex>& lock) {
    const int index = job.begun++;
    lock.unlock();
    job.task(index);
    lock.lock();
    if (++job.done == job.count) {
        isDone_.notify_all();
    }
}

ThreadPool::Job* ThreadPool::unbegun() const {
    Job* job = jobs_;
    while (job != nullptr && job->begun == job->count) {
        job = job->next;
    }
    return job;
}

void ThreadPool::remove(const Job& job) {
    Job** place = &jobs_;
    while (*place != &job) {
        place = &(*place)->next;
    }
    *place = job.next;
}

} // namespace slabcast

#include <atomic>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/base/thread_pool.h"

namespace slabcast::test {

namespace {

/// Each index once, whatever the threads.
void expectAllOnce(Executor& executor, int count) {
    std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
    executor.run(count, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    for (const std::atomic<int>& n : calls) {
        EXPECT_EQ(n, 1);
    }
}

/// Runs all in the calling thread and says how often it was asked.
class HostsExecutor : public Executor {
public:
    int concurrency() const override { return 3; }
    void run(int count, FunctionRef<void(int)> task) override {
        most = std::max(most, count);
        ++runs;
        for (int i = count - 1; i >= 0; --i) {
            task(i);
        }
    }
    int runs = 0;
    int most = 0;
};

} // namespace

TEST(ThreadPoolTest, EveryTaskRunsOnce) {
    for (const int helpers : {0, 1, 3}) {
        ThreadPool pool(helpers);
        EXPECT_EQ(pool.concurrency(), helpers + 1);
        for (const int count : {0, 1, 2, 7, 100}) {
            expectAllOnce(pool, count);
        }
    }
}

TEST(ThreadPoolTest, OneCoreRunsAllInTheCallingThread) {
    ThreadPool pool(0);
    std::set<std::thread::id> threads;
    pool.run(5, [&](int) { threads.insert(std::this_thread::get_id()); });
    EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

// Both tasks wait for each other: with one thread less this would never end.
TEST(ThreadPoolTest, TasksRunAtTheSameTime) {
    ThreadPool pool(1);
    std::atomic<int> begun{0};
    pool.run(2, [&](int) {
        ++begun;
        while (begun < 2) {
            std::this_thread::yield();
        }
    });
    EXPECT_EQ(begun, 2);
}

TEST(ThreadPoolTest, TasksMayRunTasks) {
    ThreadPool pool(2);
    std::atomic<int> leaves{0};
    pool.run(4, [&](int) { pool.run(5, [&](int) { pool.run(3, [&](int) { ++leaves; }); }); });
    EXPECT_EQ(leaves, 4 * 5 * 3);
}

TEST(ThreadPoolTest, SeveralThreadsMayCallAtOnce) {
    ThreadPool pool(2);
    std::vector<std::thread> callers;
    std::atomic<int> sum{0};
    for (int k = 0; k < 3; ++k) {
        callers.emplace_back([&] {
            for (int repeat = 0; repeat < 50; ++repeat) {
                pool.run(4, [&](int i) { sum += i; });
            }
        });
    }
    for (std::thread& caller : callers) {
        caller.join();
    }
    EXPECT_EQ(sum, 3 * 50 * (0 + 1 + 2 + 3));
}

TEST(ThreadPoolTest, KeepsItsThreads) {
    ThreadPool pool(3);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    for (int repeat = 0; repeat < 100; ++repeat) {
        pool.run(8, [&](int) {
            const std::lock_guard lock(mutex);
            threads.insert(std::this_thread::get_id());
        });
    }
    EXPECT_LE(threads.size(), 4U);
}

TEST(ExecutorTest, TheHostsIsUsedWhileItIsSet) {
    HostsExecutor host;
    setExecutor(&host);
    std::vector<int> items(100);
    EXPECT_TRUE(parallelFor(100, 7, [&](std::int64_t begin, std::int64_t end) {
        std::iota(items.begin() + begin, items.begin() + end, int(begin));
    }));
    setExecutor(nullptr);
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(items[static_cast<std::size_t>(i)], i);
    }
    EXPECT_EQ(host.runs, 1);
    EXPECT_EQ(host.most, 3);
    EXPECT_NE(&executor(), &host);
    std::atomic<int> covered{0};
    parallelFor(1000, 1, [&](std::int64_t begin, std::int64_t end) {
        covered += static_cast<int>(end - begin);
    });
    EXPECT_EQ(covered, 1000);
    EXPECT_EQ(host.runs, 1);
}

TEST(ExecutorTest, ASetTokenStopsAtTheNextRange) {
    CancelToken cancel{false};
    std::atomic<int> ranges{0};
    EXPECT_FALSE(parallelFor(
        1000, 1,
        [&](std::int64_t, std::int64_t) {
            ++ranges;
            cancel = true;
        },
        &cancel));
    EXPECT_LE(ranges, executor().concurrency());
}

} // namespace slabcast::test

#pragma once

#include <chrono>

namespace slabcast {

/// Wall-clock time in milliseconds, from the making of it on.
class Stopwatch {
public:
    double ms() const {
        return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
    }

    /// As ms(), and begins anew.
    double lapMs() {
        const Clock::time_point now = Clock::now();
        const std::chrono::duration<double, std::milli> lap = now - begin_;
        begin_ = now;
        return lap.count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
};

} // namespace slabcast

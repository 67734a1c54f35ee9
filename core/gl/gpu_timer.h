#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/gl/caps.h"
#include "core/gl/objects.h"

namespace slabcast::gl {

/// GPU time of a span of commands, from a ring of queries that is never waited for: a result
/// arrives a few frames late, a span that finds the ring full goes unmeasured, and results of a
/// disjoint period are dropped. Spans do not nest. Without the extension nothing is measured and
/// nothing is called. Source: EXT_disjoint_timer_query. Tested by: gl_objects_gl_test.cpp
class GpuTimer {
public:
    GpuTimer() = default;
    explicit GpuTimer(const Caps& caps);

    bool available() const { return available_; }
    void begin();
    void end();

    /// The oldest finished span's time in ms, each handed out once, in order.
    std::optional<double> poll();

    std::int64_t dropped() const { return dropped_; } // ring full, or disjoint

    void forget(); // contextLost

private:
    static constexpr std::size_t kRing = 8;

    bool available_ = false;
    bool open_ = false;
    std::uint64_t begun_ = 0; // spans begun and polled: their difference is what the ring holds
    std::uint64_t polled_ = 0;
    std::uint64_t suspectUntil_ = 0; // spans before this one are dropped: the GPU was disjoint
    std::int64_t dropped_ = 0;
    std::array<Query, kRing> ring_;
};

} // namespace slabcast::gl

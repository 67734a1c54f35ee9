#include "core/gl/gpu_timer.h"

namespace slabcast::gl {

namespace {

bool wasDisjoint() { // reading the flag lowers it
    GLint disjoint = 0;
    GetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
    return disjoint != 0;
}

} // namespace

GpuTimer::GpuTimer(const Caps& caps) {
    if (!caps.timerQuery || GetQueryObjectui64vEXT == nullptr) {
        return;
    }
    GLint bits = 0; // a driver may have the extension and no counter
    GetQueryiv(GL_TIME_ELAPSED_EXT, GL_QUERY_COUNTER_BITS_EXT, &bits);
    available_ = bits > 0;
    if (available_) {
        for (Query& query : ring_) {
            query = Query::make();
        }
        wasDisjoint();
    }
}

void GpuTimer::begin() {
    SLABCAST_EXPECTS(!open_, begun_);
    if (!available_) {
        return;
    }
    if (begun_ - polled_ == kRing) {
        ++dropped_;
        return;
    }
    ring_[begun_ % kRing].begin(GL_TIME_ELAPSED_EXT, "GPU timer");
    open_ = true;
}

void GpuTimer::end() {
    if (open_) {
        EndQuery(GL_TIME_ELAPSED_EXT);
        ++begun_;
        open_ = false;
    }
}

std::optional<double> GpuTimer::poll() {
    while (polled_ < begun_) {
        const GLuint id = ring_[polled_ % kRing].id();
        GLuint ready = GL_FALSE;
        GetQueryObjectuiv(id, GL_QUERY_RESULT_AVAILABLE, &ready);
        if (ready == GL_FALSE) {
            return std::nullopt;
        }
        GLuint64 nanoseconds = 0;
        GetQueryObjectui64vEXT(id, GL_QUERY_RESULT, &nanoseconds);
        if (wasDisjoint()) { // whatever is under way may have met the disjoint moment
            suspectUntil_ = begun_ + (open_ ? 1 : 0);
        }
        if (polled_++ >= suspectUntil_) {
            return static_cast<double>(nanoseconds) * 1e-6;
        }
        ++dropped_;
    }
    return std::nullopt;
}

void GpuTimer::forget() {
    for (Query& query : ring_) {
        query.forget();
    }
    available_ = false;
    open_ = false;
    polled_ = begun_;
}

} // namespace slabcast::gl

#include "core/draw/ratio_tuner.h"

#include <algorithm>
#include <limits>

#include "core/base/stopwatch.h"
#include "core/draw/renderer.h"
#include "core/gl/api.h"
#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

constexpr int kShrink = 4;
constexpr int kTimedFrames = 3;
/// A ratio whose first timed frame takes so many times the best one's is out of the race; those
/// after it, of shorter segments, are too.
constexpr double kHopeless = 8.0;

/// Viewports of a fraction of the size, each at the target's corner.
std::vector<ViewTarget> shrunk(std::span<const ViewTarget> views) {
    std::vector<ViewTarget> small(views.begin(), views.end());
    for (ViewTarget& view : small) {
        Viewport& v = view.viewport;
        v = {0, 0, std::max(1, v.width / kShrink), std::max(1, v.height / kShrink)};
    }
    return small;
}

/// Median of a few frames after one to warm up, or the first of them where it is hopeless.
/// `drawMs` draws one and tells how long that took.
template <class DrawMs>
double medianMs(DrawMs drawMs, double bestMs) {
    (void)drawMs(); // compiles
    const double second = drawMs();
    if (second > kHopeless * bestMs) {
        return second;
    }
    std::vector<double> times{second};
    while (times.size() < kTimedFrames) {
        times.push_back(drawMs());
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

} // namespace

Result<std::vector<RatioMeasurement>> measureRatios(Renderer& renderer, const Scene& scene,
                                                    const Settings& settings, const gl::Caps& caps,
                                                    std::span<const ViewTarget> views,
                                                    const std::function<double()>& nowMs) {
    const gl::StateGuard guard;
    const Stopwatch watch;
    gl::ColorTargets targets;
    std::vector<ViewTarget> small = shrunk(views);
    const bool encoded = settings.space == CompositingSpace::Display;
    const bool eightBit = encoded && settings.target == TargetFormat::Rgba8;
    glm::ivec2 extent(1);
    for (const ViewTarget& view : small) {
        extent = glm::max(extent, glm::ivec2(view.viewport.width, view.viewport.height));
    }
    Result<void> made =
        targets.resize(extent.x, extent.y, {static_cast<GLenum>(eightBit ? GL_RGBA8 : GL_RGBA16F)});
    if (!made) {
        return tl::unexpected(made.error());
    }
    targets.begin();
    for (ViewTarget& view : small) {
        view.framebuffer = targets.framebuffer();
        view.encoding = encoded ? TargetEncoding::Encoded : TargetEncoding::Linear;
    }
    std::vector<RatioMeasurement> measurements;
    double bestMs = std::numeric_limits<double>::infinity();
    for (const Ratio& ratio : ratioCandidates(settings, scene.facts())) {
        Settings fixed = settings;
        fixed.layersPerPlane = ratio.layersPerPlane;
        fixed.form = ratio.form;
        const Result<FramePlan> candidate = plan(scene.facts(), fixed, caps, {});
        if (!candidate) {
            return tl::unexpected(candidate.error());
        }
        if (Result<void> ready = renderer.prepare(scene, *candidate, small); !ready) {
            return tl::unexpected(ready.error());
        }
        const auto drawMs = [&] {
            const double begin = nowMs ? nowMs() : watch.ms();
            (void)renderer.draw(scene, *candidate, small); // fails where the frame itself will
            gl::Finish();
            return (nowMs ? nowMs() : watch.ms()) - begin;
        };
        const double ms = medianMs(drawMs, bestMs);
        measurements.push_back({ratio, ms});
        bestMs = std::min(bestMs, ms);
        if (ms > kHopeless * bestMs) {
            break;
        }
    }
    return measurements;
}

} // namespace slabcast

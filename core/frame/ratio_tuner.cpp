#include "core/frame/ratio_tuner.h"

#include <algorithm>
#include <chrono>

#include "core/gl/api.h"
#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

constexpr int kShrink = 4;
constexpr int kTimedFrames = 3;

double drawMs(Renderer& renderer, const Scene& scene, const FramePlan& plan,
              std::span<const ViewTarget> views) {
    const auto start = std::chrono::steady_clock::now();
    (void)renderer.draw(scene, plan, views); // draws without a layer of our own: cannot fail
    gl::Finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

} // namespace

Result<std::vector<RatioMeasurement>> measureRatios(Renderer& renderer, const Scene& scene,
                                                    const Settings& settings, const gl::Caps& caps,
                                                    std::span<const ViewTarget> views) {
    const gl::StateGuard guard;
    gl::ColorTargets targets;
    std::vector<ViewTarget> small(views.begin(), views.end());
    glm::ivec2 extent(1);
    for (ViewTarget& view : small) {
        Viewport& v = view.viewport;
        v = {0, 0, std::max(1, v.width / kShrink), std::max(1, v.height / kShrink)};
        extent = glm::max(extent, glm::ivec2(v.width, v.height));
    }
    const bool encoded = settings.space == CompositingSpace::Display;
    const bool eightBit = encoded && settings.target == TargetFormat::Rgba8;
    std::vector<RatioMeasurement> measurements;
    for (const Ratio& ratio : ratioCandidates(settings, scene.facts())) {
        Settings fixed = settings;
        fixed.layersPerPlane = ratio.layersPerPlane;
        fixed.form = ratio.form;
        const Result<FramePlan> candidate = plan(scene.facts(), fixed, caps, {});
        if (!candidate) {
            return tl::unexpected(candidate.error());
        }
        if (Result<void> ready = renderer.prepare(scene, *candidate); !ready) {
            return tl::unexpected(ready.error());
        }
        Result<void> made = targets.resize(extent.x, extent.y,
                                           {static_cast<GLenum>(eightBit ? GL_RGBA8 : GL_RGBA16F)});
        if (!made) {
            return tl::unexpected(made.error());
        }
        targets.begin();
        for (ViewTarget& view : small) {
            view.framebuffer = targets.framebuffer();
            view.encoding = encoded ? TargetEncoding::Encoded : TargetEncoding::Linear;
        }
        drawMs(renderer, scene, *candidate, small);
        std::vector<double> times;
        for (int k = 0; k < kTimedFrames; ++k) {
            times.push_back(drawMs(renderer, scene, *candidate, small));
        }
        std::sort(times.begin(), times.end());
        measurements.push_back({ratio, times[times.size() / 2]});
    }
    return measurements;
}

} // namespace slabcast

#include "core/draw/warm_up.h"

#include <algorithm>
#include <cmath>

#include "core/draw/renderer.h"
#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

/// Facts of what TFs may make of the scene: from as thin as can be to as dense, in steps of a
/// fifth. Some of it is visible, so little that skipping pays.
std::vector<SceneFacts> factsOfOtherTransfers(const Scene& scene) {
    SceneFacts facts = scene.facts();
    facts.anythingVisible = true;
    facts.occupiedFraction = 0.0;
    std::vector<SceneFacts> all;
    for (double exponent = -30.0; exponent <= 20.0; exponent += 0.25) {
        facts.maxExtinctionPerMm = std::exp2(exponent);
        all.push_back(facts);
    }
    return all;
}

/// Drivers compile nothing more for the one than for the other.
bool compileAlike(const FramePlan& a, const FramePlan& b) {
    return a.variant == b.variant && a.order == b.order &&
           (a.planesPerMark > 0) == (b.planesPerMark > 0);
}

/// Plans of one scene, of those that compile alike the first.
Result<std::vector<FramePlan>> plansOf(const Scene& scene, Settings settings, const gl::Caps& caps,
                                       std::span<const RatioMeasurement> measurements) {
    std::vector<FramePlan> plans;
    const std::optional<SkipStructure> asked = settings.skip;
    for (const SceneFacts& facts : factsOfOtherTransfers(scene)) {
        for (const std::optional<SkipStructure> skip :
             {asked, std::optional(SkipStructure::None)}) {
            settings.skip = skip;
            Result<FramePlan> one = plan(facts, settings, caps, measurements);
            if (!one) {
                return tl::unexpected(one.error());
            }
            one->tighten = false; // there may be nothing to tighten around
            const bool isNew =
                std::none_of(plans.begin(), plans.end(),
                             [&](const FramePlan& known) { return compileAlike(known, *one); });
            if (isNew) {
                plans.push_back(std::move(*one));
            }
        }
    }
    return plans;
}

} // namespace

Result<void> warmUpForEditing(Renderer& renderer, const LiveScene& scene, const Settings& settings,
                              const gl::Caps& caps, std::span<const RatioMeasurement> measurements,
                              std::span<const ViewTarget> views) {
    const gl::StateGuard guard;
    gl::ColorTargets pixel;
    const bool eightBit =
        settings.space == CompositingSpace::Display && settings.target == TargetFormat::Rgba8;
    Result<void> done = pixel.resize(1, 1, {static_cast<GLenum>(eightBit ? GL_RGBA8 : GL_RGBA16F)});
    if (!done) {
        return done;
    }
    std::vector<ViewTarget> targets(views.begin(), views.end());
    for (ViewTarget& target : targets) {
        target.framebuffer = pixel.framebuffer();
        target.viewport = {0, 0, 1, 1};
    }
    for (const Scene& served : scene.withEachServing()) {
        const Result<std::vector<FramePlan>> plans = plansOf(served, settings, caps, measurements);
        if (!plans) {
            return tl::unexpected(plans.error());
        }
        for (const FramePlan& one : *plans) {
            done = renderer.prepare(served, one, views).and_then([&] {
                return renderer.draw(served, one, targets);
            });
            if (!done) {
                return done;
            }
        }
    }
    return {};
}

} // namespace slabcast

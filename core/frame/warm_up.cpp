#include "core/frame/warm_up.h"

#include <algorithm>

#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

/// Facts of what TFs may make of the scene: as thin, or as dense, as can be. Some of it is visible,
/// so little that skipping pays.
std::vector<SceneFacts> factsOfOtherTransfers(const Scene& scene) {
    SceneFacts facts = scene.facts();
    facts.anythingVisible = true;
    facts.occupiedFraction = 0.0;
    std::vector<SceneFacts> all;
    for (const double extinctionPerMm : {1e-9, 1e9}) {
        facts.maxExtinctionPerMm = extinctionPerMm;
        all.push_back(facts);
    }
    return all;
}

/// Plans of one scene, each but once.
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
            if (std::find(plans.begin(), plans.end(), *one) == plans.end()) {
                plans.push_back(std::move(*one));
            }
        }
    }
    return plans;
}

} // namespace

Result<void> warmUpForEditing(Renderer& renderer, const Scene& scene, const Settings& settings,
                              const gl::Caps& caps, std::span<const RatioMeasurement> measurements,
                              std::span<const ViewTarget> views) {
    SLABCAST_EXPECTS(scene.live() != nullptr, scene.lookGeneration());
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
            done = renderer.prepare(served, one).and_then([&] {
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

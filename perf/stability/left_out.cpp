#include <algorithm>
#include <chrono>

#include "core/gl/api.h"
#include "perf/stability/left_out_scenes.h"

namespace slabcast::stability {

namespace {

glm::ivec2 sizeOf(const Bench& bench) {
    return glm::ivec2(bench.reduced() ? 48 : 96);
}

/// Light that changes nothing and costs as much as any.
constexpr ShadingParameters kIdleLight{.ambient = 1.0, .diffuse = 0.0, .specular = 0.0};

Settings settingsOfAll(const FrugalScene& setup) {
    Settings settings = settingsOf({"hybrid", 16, TargetFormat::Rgba16f});
    settings.skip.reset(); // the plan decides
    settings.tighten = true;
    settings.termination = Settings{}.termination;
    settings.form = SegmentForm::Loop; // on any device
    settings.shaded = setup.lit;
    return settings;
}

/// The same frame with everything in, needed or not.
FramePlan withAll(FramePlan plan, const Scene& sceneWithAll) {
    plan.look = sceneWithAll.lookGeneration();
    plan.skip = SkipStructure::Proximity;
    plan.variant.skip = SkipForm::Balls;
    plan.variant.shaded = true;
    plan.variant.terminates = true;
    plan.terminationAlpha = *Settings{}.termination;
    plan.tighten = false;
    plan.drawsNothing = false;
    return plan;
}

/// One frame until the GPU has finished it, ms.
Result<double> frameMs(Bench& bench, const Scene& scene, const FramePlan& plan,
                       const ViewTarget& where) {
    if (Result<void> ready = bench.renderer().prepare(scene, plan, {&where, 1}); !ready) {
        return tl::unexpected(ready.error());
    }
    gl::Finish();
    const auto start = std::chrono::steady_clock::now();
    if (Result<void> done = bench.renderer().draw(scene, plan, {&where, 1}); !done) {
        return tl::unexpected(done.error());
    }
    gl::Finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

/// The least of so many frames of either, drawn in turn.
struct Times {
    int frames;
    double frugalMs = 1e9;
    double allMs = 1e9;
};

Result<Times> timed(Bench& bench, const Scene& scene, const FramePlan& plan,
                    const Scene& sceneWithAll, const View& view) {
    const glm::ivec2 size = sizeOf(bench);
    gl::ColorTargets target;
    if (Result<void> made = target.resize(size.x, size.y, {GL_RGBA16F}); !made) {
        return tl::unexpected(made.error());
    }
    target.begin();
    const ViewTarget where{view, target.framebuffer(), {0, 0, size.x, size.y}};
    const FramePlan all = withAll(plan, sceneWithAll);
    Times least{.frames = bench.reduced() ? 3 : 9};
    for (int k = 0; k <= least.frames; ++k) {
        const Result<double> frugal = frameMs(bench, scene, plan, where);
        const Result<double> full = frameMs(bench, sceneWithAll, all, where);
        if (!frugal || !full) {
            return tl::unexpected(frugal ? full.error() : frugal.error());
        }
        if (k > 0) { // the first warms up
            least.frugalMs = std::min(least.frugalMs, *frugal);
            least.allMs = std::min(least.allMs, *full);
        }
    }
    return least;
}

Case caseOf(const FrugalScene& setup, const char* what, const char* quantity, const char* reason) {
    return {.family = "left-out",
            .name = named({setup.name, what}),
            .quantity = quantity,
            .reason = reason};
}

std::vector<std::string> reasonLines(const FramePlan& plan) {
    std::vector<std::string> lines;
    for (const ReasonText& reason : explained(plan)) {
        lines.push_back(reason.what + ": " + reason.why);
    }
    return lines;
}

void recordResources(Bench& bench, const FrugalScene& setup, const Evidence& evidence,
                     const Times& times) {
    const std::vector<std::string>& active = evidence.resources.samplers;
    std::vector<std::string> wrong;
    std::set_symmetric_difference(active.begin(), active.end(), setup.samplers.begin(),
                                  setup.samplers.end(), std::back_inserter(wrong));
    Case samplers = caseOf(setup, "samplers", "samplers of the program too many or missing",
                           "the driver reports exactly those that the scene needs");
    samplers.measured = double(wrong.size());
    samplers.leftOut =
        LeftOut{.plan = reasonLines(evidence.plan),
                .activeUniforms = evidence.resources.uniforms,
                .samplers = active,
                .fragments = evidence.work.fragments,
                .layers = evidence.work.layersEvaluated,
                .volumeAndSkipBytes = evidence.memory.volumeBytes + evidence.memory.skipBytes,
                .timedFrames = times.frames,
                .leastFrameMs = times.frugalMs,
                .leastFrameMsWithAll = times.allMs};
    bench.record(std::move(samplers));

    Case text = caseOf(setup, "program text", "features that are off and yet in the program's text",
                       "skipping, gradients, exact fetches, termination and counting each have a "
                       "text that nothing else has");
    text.measured = textOutOfPlace(evidence.plan.variant);
    bench.record(std::move(text));

    const bool nothing = evidence.plan.drawsNothing;
    const bool skips = evidence.plan.skip != SkipStructure::None;
    Case memory = caseOf(setup, "memory", "bytes of volume and skip structure",
                         "one texel per voxel; one byte per block where space is skipped; nothing "
                         "where nothing is drawn");
    memory.bound = nothing ? 0.0
                           : double(evidence.scene.texels().data.size()) +
                                 (skips ? double(gpuBytes(evidence.scene.skip())) : 0.0);
    memory.measured = double(evidence.memory.volumeBytes + evidence.memory.skipBytes);
    bench.record(std::move(memory));
}

/// What the scene needs, drawn, and the same with everything in.
void recordPictures(Bench& bench, const FrugalScene& setup, const FramePlan& plan,
                    const Drawn& frugal, const Drawn& full) {
    Case picture = caseOf(
        setup, "picture", "largest difference from the picture with everything in, of full scale",
        "leaving out changes nothing: what is left is one rounding of the target per plane "
        "and picture, what early termination may lose (1/256, and as much of what is left), "
        "and float32's rounding of a light that changes nothing");
    picture.bound = 1.0 / 255.0 + plan.planes * 0x1p-10 + 0x1p-20;
    const std::vector<glm::dvec4> expected(full.picture.pixels.begin(), full.picture.pixels.end());
    picture.measured = largestDifference(frugal.picture, expected);
    picture.pictures = {{"what it needs", frugal.picture}, {"everything in", full.picture}};
    bench.record(std::move(picture));
}

/// Of the programs that a renderer built which drew nothing else.
Result<gl::ActiveResources> resourcesOf(Bench& bench, const Scene& scene, const FramePlan& plan,
                                        const View& view, glm::ivec2 size) {
    Result<Renderer> fresh = Renderer::create(bench.device());
    if (!fresh) {
        return tl::unexpected(fresh.error());
    }
    Bench alone(*fresh, bench.device(), bench.reduced());
    const Result<Drawn> drawn = alone.draw(scene, plan, view, size);
    return drawn ? Result<gl::ActiveResources>(fresh->resources(plan.variant))
                 : tl::unexpected(drawn.error());
}

Result<void> judge(Bench& bench, const FrugalScene& setup) {
    const Volume volume = setup.volume();
    const Appearance look{.tf = setup.tf,
                          .shading = setup.lit ? std::optional(ShadingParameters{}) : std::nullopt};
    Appearance lookWithAll = look;
    lookWithAll.shading = setup.lit ? look.shading : std::optional(kIdleLight);
    const Result<Scene> scene = bench.scene(volume, look);
    const Result<Scene> sceneWithAll = bench.scene(volume, lookWithAll);
    if (!scene || !sceneWithAll) {
        return tl::unexpected(scene ? sceneWithAll.error() : scene.error());
    }
    const Result<FramePlan> plan = bench.plan(*scene, settingsOfAll(setup));
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    const glm::ivec2 size = sizeOf(bench);
    const View view = orbitView(*scene, setup.camera, setup.fovDegrees, size);
    const Result<Times> times = timed(bench, *scene, *plan, *sceneWithAll, view);
    const Result<Drawn> full = bench.draw(*sceneWithAll, withAll(*plan, *sceneWithAll), view, size);
    const Result<Drawn> frugal = bench.draw(*scene, *plan, view, size); // the last: its textures
    const Result<WorkCounters> work = bench.countWork(*scene, *plan, view, size);
    const Result<gl::ActiveResources> resources = resourcesOf(bench, *scene, *plan, view, size);
    if (!times || !full || !frugal || !work || !resources) {
        return tl::unexpected(!times    ? times.error()
                              : !full   ? full.error()
                              : !frugal ? frugal.error()
                              : !work   ? work.error()
                                        : resources.error());
    }
    const Evidence evidence{
        *scene, *plan, view, size, *resources, *work, bench.renderer().gpuMemory()};
    recordResources(bench, setup, evidence, *times);
    recordPictures(bench, setup, *plan, *frugal, *full);
    Case claim = caseOf(setup, "work", setup.claim.quantity, setup.claim.reason);
    claim.bound = setup.claim.bound(evidence);
    claim.measured = setup.claim.measured(evidence);
    bench.record(std::move(claim));
    return {};
}

} // namespace

void leftOutCases(Bench& bench) {
    for (const FrugalScene& setup : frugalScenes()) {
        if (Result<void> done = judge(bench, setup); !done) {
            bench.recordFailure({.family = "left-out", .name = setup.name}, done.error());
        }
    }
}

} // namespace slabcast::stability

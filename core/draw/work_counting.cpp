#include <algorithm>
#include <array>

#include "core/draw/prepare_check.h"
#include "core/draw/renderer_state.h"
#include "core/gl/api.h"
#include "core/plan/shader_resources.h"

// What a frame costs, by drawing it with programs that count: Renderer::countWork() and
// workPerPixel().
namespace slabcast {

/// Counts run by run. What is left out behind a run depends on the picture so far, so that the
/// picture is drawn beside.
Result<void> Renderer::State::count(const Scene& scene, const FramePlan& plan,
                                    const ViewTarget& target, gl::StateScope& state) {
    const Viewport& v = target.viewport;
    const glm::ivec2 size(v.width, v.height);
    const bool marked = plan.planesPerMark > 0;
    const bool needsPicture = marked || plan.variant.fetchesTarget;
    state.touch();
    const std::array formats{static_cast<GLenum>(GL_RGBA32F), static_cast<GLenum>(GL_RGBA32F),
                             static_cast<GLenum>(GL_DEPTH_COMPONENT16)};
    Result<void> ready =
        counters.resize(v.width, v.height, std::span(formats.data(), marked ? 3 : 2))
            .and_then([&] { return needMarks(plan, state); })
            .and_then([&] {
                return prepareViews(scene, plan, {&target, 1}, state);
            })
            .and_then([&] {
                return needsPicture ? resizeLayer(scene, plan, size, state) : Result<void>{};
            });
    if (!ready) {
        return ready;
    }
    const ShaderVariant drawn = stage(0, scene, plan, target.view, {0, 0, v.width, v.height});
    ShaderVariant counting = drawn;
    counting.counts = true;
    const Result<const gl::Program*> counts = programs.need(counting);
    const Result<const gl::Program*> colours = needsPicture ? programs.need(drawn) : counts;
    if (!counts || !colours) {
        return tl::unexpected(counts ? colours.error() : counts.error());
    }
    drawer.upload(1);
    BlendSwitch blending(planeBlending(plan)); // before what clears
    counters.begin();
    if (needsPicture) {
        constexpr GLuint kUnit = unitOf(Sampler::LayerBefore);
        gl::ActiveTexture(GL_TEXTURE0 + kUnit);
        gl::BindTexture(GL_TEXTURE_2D, layer.texture(0));
        gl::BindSampler(kUnit, 0);
        layer.clear();
    }
    textures.bind(scene.skip());
    drawer.useVertices();
    const StackShape& shape = drawer.begin(0);
    PlaneRun run;
    PlaneRuns runs(plan.order, shape, plan.variant.fetchesTarget ? 1 : plan.planesPerMark);
    while (runs.next(run)) {
        gl::Disable(GL_DEPTH_TEST);
        blending.to(kSum);
        drawRun(counters, plan, size, **counts, shape, run);
        if (!needsPicture || runs.done()) {
            continue;
        }
        blending.to(planeBlending(plan));
        drawRun(layer, plan, size, **colours, shape, run);
        if (marked) {
            mark(layer, plan, size);
            mark(counters, plan, size);
        }
    }
    return {};
}

Result<std::vector<PixelWork>> Renderer::workPerPixel(const Scene& scene, const FramePlan& plan,
                                                      const ViewTarget& target) {
    if (!state_->caps.floatBlend) {
        return fail(ErrorCode::DeviceUnsupported,
                    "work cannot be counted on this device: it does not blend float32 "
                    "targets (GL_EXT_float_blend)");
    }
    if (Result<void> ok = checkPlan(plan, scene).and_then([&] {
            return checkViews({&target, 1});
        });
        !ok) {
        return tl::unexpected(ok.error());
    }
    const Viewport& v = target.viewport;
    std::vector<PixelWork> work(static_cast<std::size_t>(std::max(v.width, 0)) *
                                std::max(v.height, 0));
    if (plan.drawsNothing || work.empty()) {
        return work;
    }
    gl::StateScope scope(state_->hostState);
    if (Result<void> done = state_->count(scene, plan, target, scope); !done) {
        return tl::unexpected(done.error());
    }
    const std::vector<glm::vec4> layers = state_->counters.read(0);
    const std::vector<glm::vec4> fetches = state_->counters.read(1);
    for (std::size_t i = 0; i < work.size(); ++i) {
        work[i] = {.fragments = layers[i].x,
                   .layersEvaluated = layers[i].z,
                   .layersSkipped = layers[i].y - layers[i].z,
                   .volumeFetches = fetches[i].x,
                   .skipFetches = layers[i].w,
                   .stretches = fetches[i].y,
                   .blocksVisited = fetches[i].z};
    }
    return work;
}

Result<WorkCounters> Renderer::countWork(const Scene& scene, const FramePlan& plan,
                                         std::span<const ViewTarget> views) {
    WorkCounters sums;
    for (const ViewTarget& target : views) {
        const Result<std::vector<PixelWork>> work = workPerPixel(scene, plan, target);
        if (!work) {
            return tl::unexpected(work.error());
        }
        for (const PixelWork& pixel : *work) {
            sums += pixel;
        }
    }
    return sums;
}

} // namespace slabcast

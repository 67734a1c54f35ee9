#include "core/draw/renderer.h"

#include <algorithm>
#include <cmath>

#include "core/draw/box_cache.h"
#include "core/draw/layer_compositor.h"
#include "core/draw/plane_blending.h"
#include "core/draw/prepare_check.h"
#include "core/draw/program_cache.h"
#include "core/draw/saturation_marks.h"
#include "core/draw/stack_drawer.h"
#include "core/gl/api.h"
#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"
#include "core/plan/shader_resources.h"
#include "core/scene/gpu_scene.h"
#include "core/skip/gpu/gpu_built_skip.h"

namespace slabcast {

namespace {

GLenum glFormat(TargetFormat format) {
    return format == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
}

/// To a target that is not in the space, and to an sRGB format, which encodes by itself.
LayerConversion conversionTo(CompositingSpace space, TargetEncoding encoding) {
    if (space == CompositingSpace::Display) {
        return encoding == TargetEncoding::Encoded ? LayerConversion::None
                                                   : LayerConversion::Decode;
    }
    return encoding == TargetEncoding::Encoded ? LayerConversion::Encode : LayerConversion::None;
}

/// The framebuffer may be blended into directly where it holds what is composited: planes over what
/// is there. An sRGB format encodes at every blend.
bool needsLayer(const FramePlan& plan, TargetEncoding encoding) {
    return plan.order == BlendOrder::FrontToBack || encoding == TargetEncoding::SrgbFormat ||
           conversionTo(plan.space, encoding) != LayerConversion::None;
}

bool isEmpty(const Viewport& v) { // a window made small
    return v.width <= 0 || v.height <= 0;
}

/// Of the rays of a view the longest one's layers, those in its corners.
double longestLayerMm(const FramePlan& plan, const Frustum& f) {
    const glm::dvec2 widest(std::max(std::abs(f.left), std::abs(f.right)),
                            std::max(std::abs(f.bottom), std::abs(f.top)));
    return plan.lattice.spacingMm * std::sqrt(1.0 + glm::dot(widest, widest));
}

} // namespace

struct Renderer::State {
    explicit State(Device its) : device(std::move(its)), caps(device.caps()) {}

    Device device;
    const gl::Caps& caps;
    GpuScene textures;
    StackDrawer drawer;
    LayerCompositor compositor;
    SaturationMarks marks;
    gl::ColorTargets layer, counters;
    std::optional<GpuSkipBuilder> builder; // made when it is first needed
    bool created = false;                  // the objects that do not depend on a scene
    ProgramCache programs;
    BoxCache boxes;

    Result<void> createFixed();
    /// What the views need beside textures and shaders.
    Result<void> prepareViews(const Scene& scene, const FramePlan& plan,
                              std::span<const ViewTarget> views);
    /// Whether prepareViews() was called for views as large and wide.
    bool servesView(const Scene& scene, const FramePlan& plan, const ViewTarget& target) const;
    /// Readies the view's planes for drawing; returns the runs to draw them in.
    std::vector<PlaneRun> beginStack(const Scene& scene, const FramePlan& plan, const View& view,
                                     const Viewport& viewport, int planesPerRun);
    Result<void> resizeLayer(const Scene& scene, const FramePlan& plan, glm::ivec2 size);
    std::vector<GLenum> layerFormats(const Scene& scene, const FramePlan& plan) const;
    void drawRun(const gl::ColorTargets& into, const FramePlan& plan, glm::ivec2 size,
                 const gl::Program& program, const PlaneRun& run) const;
    /// Marks what the layer has of saturated pixels in the depth of `marked`.
    void mark(const gl::ColorTargets& marked, const FramePlan& plan, glm::ivec2 size) const;
    void drawLayer(const Scene& scene, const FramePlan& plan, const ViewTarget& target,
                   const gl::Program& program);
    Result<void> count(const Scene& scene, const FramePlan& plan, const ViewTarget& target);
};

Result<void> Renderer::State::createFixed() {
    if (created) {
        return {};
    }
    drawer.create();
    Result<void> done = compositor.create();
    created = done.has_value();
    return done;
}

std::vector<PlaneRun> Renderer::State::beginStack(const Scene& scene, const FramePlan& plan,
                                                  const View& view, const Viewport& viewport,
                                                  int planesPerRun) {
    const RayFrame frame = makeRayFrame(view, viewport, scene.geometry(), plan.lattice);
    SLABCAST_EXPECTS(!plan.tighten || scene.skip().exists(), plan.tighten);
    ProxyStack stack;
    if (plan.tighten) {
        stack =
            tightStack(frame, view.frustum, view.viewFromModel * scene.geometry().modelFromUvw(),
                       boxes.boxes(), plan.planes, plan.layersPerPlane);
    } else {
        stack = sphereStack(frame, view.frustum, plan.planes, plan.layersPerPlane);
    }
    textures.bind(scene.skip());
    drawer.begin(makeFrameBlock(frame, scene, plan), stack, view.frustum, plan.tighten);
    return runsOf(plan.order, stack, planesPerRun);
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(const Device& device) {
    return create(device, {});
}

Result<Renderer> Renderer::create(const Device& device, const MeasuringText& measuring) {
    auto state = std::make_unique<State>(device);
    state->programs = ProgramCache(measuring);
    const gl::StateGuard guard;
    if (Result<void> done = state->createFixed(); !done) {
        return tl::unexpected(done.error());
    }
    return Renderer(std::move(state));
}

Result<void> Renderer::provide(Scene& scene, const Needs& needs) {
    const bool onGpu =
        needs.builder == SkipBuilder::Gpu ||
        (needs.builder == SkipBuilder::Auto && !state_->device.quirks().computeIsSlow);
    if (!onGpu || needs.skip.structure == SkipStructure::None || scene.provides(needs)) {
        return scene.provide(needs);
    }
    Needs allElse = needs;
    allElse.skip = noSkip().options;
    Result<void> built =
        check(needs.skip).and_then([&] { return scene.provide(allElse); }).and_then([&] {
            return buildSkip(scene, needs.skip);
        });
    if (built || built.error().code != ErrorCode::DeviceUnsupported) {
        return built;
    }
    state_->device.log(built.error().detail);
    return scene.provide(needs);
}

Result<FramePlan> Renderer::plan(Scene& scene, const Settings& settings,
                                 std::span<const RatioMeasurement> measurements) {
    return provide(scene, needsOf(settings)).and_then([&] {
        return slabcast::plan(scene.facts(), settings, state_->caps, measurements);
    });
}

Result<FramePlan> Renderer::plan(const LiveScene& scene, const Settings& settings,
                                 std::span<const RatioMeasurement> measurements) const {
    return slabcast::plan(scene.scene().facts(), settings, state_->caps, measurements);
}

Result<void> Renderer::buildSkip(Scene& scene, const SkipOptions& options) {
    const gl::StateGuard guard;
    if (!state_->builder) {
        Result<GpuSkipBuilder> made = GpuSkipBuilder::create(state_->caps);
        if (!made) {
            return tl::unexpected(made.error());
        }
        state_->builder = std::move(*made);
    }
    const bool pre = scene.classified() != nullptr;
    const Result<GLuint> volume = state_->textures.volumeTexture(scene, pre, state_->caps);
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    return scene.buildSkip([&](const SkipSource& source) -> Result<BuiltSkip> {
        const Result<GpuVoxels> voxels =
            pre ? gpuVoxelsOfAlpha(*volume, scene.geometry().dims)
                : gpuVoxels(*volume, scene.texels().format, source.codes);
        if (!voxels) {
            return tl::unexpected(voxels.error());
        }
        return buildSkipOnGpu(*state_->builder, *voxels, source, options)
            .map([&](GpuBuiltSkip&& built) {
                state_->textures.adopt(built.skip, std::move(built.texture));
                return std::move(built.skip);
            });
    });
}

Result<void> Renderer::prepare(const Scene& scene, const FramePlan& plan,
                               std::span<const ViewTarget> views) {
    if (Result<void> ok = checkPlan(plan, scene).and_then([&] { return checkViews(views); }); !ok) {
        return ok;
    }
    if (plan.drawsNothing) {
        const gl::StateGuard guard;
        if (scene.live() == nullptr) { // else the TF may be another one in the next frame
            state_->layer = {};
            state_->counters = {};
        }
        return state_->textures.update(scene, plan, state_->caps);
    }
    const gl::StateGuard guard;
    if (Result<void> done = state_->createFixed(); !done) {
        return done;
    }
    if (Result<void> done = state_->textures.update(scene, plan, state_->caps); !done) {
        return done;
    }
    if (plan.planesPerMark > 0) {
        if (Result<void> done = state_->marks.create(); !done) {
            return done;
        }
    }
    const Result<const gl::Program*> program = state_->programs.need(plan.variant);
    return program ? state_->prepareViews(scene, plan, views) : tl::unexpected(program.error());
}

Result<void> Renderer::State::prepareViews(const Scene& scene, const FramePlan& plan,
                                           std::span<const ViewTarget> views) {
    double longest = 0.0;
    glm::ivec2 layerSize(0);
    for (const ViewTarget& target : views) {
        const Viewport& v = target.viewport;
        if (isEmpty(v)) {
            continue;
        }
        longest = std::max(longest, longestLayerMm(plan, target.view.frustum));
        if (needsLayer(plan, target.encoding)) {
            layerSize = glm::max(layerSize, glm::ivec2(v.width, v.height));
        }
    }
    if (plan.tighten && longest > 0.0) {
        SLABCAST_EXPECTS(scene.skip().exists(), plan.tighten);
        boxes.prepare(scene, longest);
    }
    return layerSize.x > 0 ? resizeLayer(scene, plan, layerSize) : Result<void>{};
}

bool Renderer::State::servesView(const Scene& scene, const FramePlan& plan,
                                 const ViewTarget& target) const {
    const Viewport& v = target.viewport;
    const bool tightened =
        !plan.tighten || boxes.serve(scene, longestLayerMm(plan, target.view.frustum));
    const bool layered =
        !needsLayer(plan, target.encoding) ||
        layer.holds(v.width, v.height, glFormat(plan.target), plan.planesPerMark > 0);
    return tightened && layered;
}

std::vector<GLenum> Renderer::State::layerFormats(const Scene& scene, const FramePlan& plan) const {
    std::vector<GLenum> formats{glFormat(plan.target)};
    // TFs that need marks and others that do not share it while the scene is edited.
    if (plan.planesPerMark > 0 || (scene.live() != nullptr && layer.hasDepth())) {
        formats.push_back(GL_DEPTH_COMPONENT16);
    }
    return formats;
}

/// Only ever grows: views of different sizes share it without a new one in every frame.
Result<void> Renderer::State::resizeLayer(const Scene& scene, const FramePlan& plan,
                                          glm::ivec2 size) {
    return layer.resize(std::max(size.x, layer.width()), std::max(size.y, layer.height()),
                        layerFormats(scene, plan));
}

void Renderer::State::drawRun(const gl::ColorTargets& into, const FramePlan& plan, glm::ivec2 size,
                              const gl::Program& program, const PlaneRun& run) const {
    gl::BindFramebuffer(GL_FRAMEBUFFER, into.framebuffer());
    gl::Viewport(0, 0, size.x, size.y);
    if (plan.planesPerMark > 0) {
        SaturationMarks::useForPlanes();
    }
    drawer.draw(program, run);
}

void Renderer::State::mark(const gl::ColorTargets& marked, const FramePlan& plan,
                           glm::ivec2 size) const {
    marks.mark(layer.texture(0), marked.depth(), size, saturatedAlpha(plan));
}

void Renderer::State::drawLayer(const Scene& scene, const FramePlan& plan, const ViewTarget& target,
                                const gl::Program& program) {
    const Viewport& v = target.viewport;
    const glm::ivec2 size(v.width, v.height);
    usePlaneBlending(plan.order);
    layer.begin();
    const std::vector<PlaneRun> runs =
        beginStack(scene, plan, target.view, {0, 0, v.width, v.height}, plan.planesPerMark);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        if (i > 0) {
            mark(layer, plan, size);
        }
        drawRun(layer, plan, size, program, runs[i]);
    }
    layer.dropDepth();
    useBlending(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl::BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl::Viewport(v.x, v.y, v.width, v.height);
    compositor.composite(layer.texture(0), v.x, v.y, conversionTo(plan.space, target.encoding));
}

Result<void> Renderer::draw(const Scene& scene, const FramePlan& plan,
                            std::span<const ViewTarget> views) {
    if (Result<void> ok = checkPlan(plan, scene).and_then([&] { return checkViews(views); }); !ok) {
        return ok;
    }
    if (plan.drawsNothing) {
        return {};
    }
    const gl::StateGuard guard;
    const gl::Program* program = state_->programs.find(plan.variant);
    if (program == nullptr || !state_->textures.serve(scene, plan)) {
        return fail(ErrorCode::InvalidArgument,
                    "scene and plan were not prepared: call prepare() with them first");
    }
    for (const ViewTarget& target : views) {
        if (!isEmpty(target.viewport) && !state_->servesView(scene, plan, target)) {
            return fail(ErrorCode::InvalidArgument,
                        "a view is larger or wider than those that were prepared, or its target is "
                        "encoded otherwise: prepare() with these views first");
        }
    }
    for (const ViewTarget& target : views) {
        const Viewport& v = target.viewport;
        if (isEmpty(v)) {
            continue;
        }
        if (needsLayer(plan, target.encoding)) {
            state_->drawLayer(scene, plan, target, *program);
            continue;
        }
        usePlaneBlending(plan.order);
        gl::BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        gl::Viewport(v.x, v.y, v.width, v.height);
        for (const PlaneRun& run : state_->beginStack(scene, plan, target.view, v, 0)) {
            state_->drawer.draw(*program, run);
        }
    }
    return {};
}

/// Counts run by run. What is left out behind a run depends on the picture so far, so that the
/// picture is drawn beside.
Result<void> Renderer::State::count(const Scene& scene, const FramePlan& plan,
                                    const ViewTarget& target) {
    const Viewport& v = target.viewport;
    const glm::ivec2 size(v.width, v.height);
    const bool marked = plan.planesPerMark > 0;
    const bool needsPicture = marked || plan.variant.fetchesTarget;
    ShaderVariant counting = plan.variant;
    counting.counts = true;
    const Result<const gl::Program*> counts = programs.need(counting);
    const Result<const gl::Program*> colours = needsPicture ? programs.need(plan.variant) : counts;
    if (!counts || !colours) {
        return tl::unexpected(counts ? colours.error() : counts.error());
    }
    std::vector<GLenum> formats{GL_RGBA32F, GL_RGBA32F};
    formats.resize(marked ? 3 : 2, GL_DEPTH_COMPONENT16);
    Result<void> resized =
        counters.resize(v.width, v.height, formats)
            .and_then([&] {
                return prepareViews(scene, plan, {&target, 1});
            })
            .and_then(
                [&] { return needsPicture ? resizeLayer(scene, plan, size) : Result<void>{}; });
    if (!resized) {
        return resized;
    }
    usePlaneBlending(plan.order); // before what clears
    counters.begin();
    if (needsPicture) {
        layer.begin();
    }
    const std::vector<PlaneRun> runs =
        beginStack(scene, plan, target.view, {0, 0, v.width, v.height},
                   plan.variant.fetchesTarget ? 1 : plan.planesPerMark);
    for (const PlaneRun& run : runs) {
        useBlending(GL_ONE, GL_ONE);
        if (needsPicture) {
            constexpr GLuint kUnit = unitOf(Sampler::LayerBefore);
            gl::ActiveTexture(GL_TEXTURE0 + kUnit);
            gl::BindTexture(GL_TEXTURE_2D, layer.texture(0));
            gl::BindSampler(kUnit, 0);
        }
        drawRun(counters, plan, size, **counts, run);
        if (!needsPicture || &run == &runs.back()) {
            continue;
        }
        usePlaneBlending(plan.order);
        drawRun(layer, plan, size, **colours, run);
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
    const gl::StateGuard guard;
    if (Result<void> done = state_->count(scene, plan, target); !done) {
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

double Renderer::compileMs(const ShaderVariant& variant) const {
    const gl::Program* program = state_->programs.find(variant);
    return program == nullptr ? 0.0 : program->buildMs();
}

gl::ActiveResources Renderer::resources(const ShaderVariant& variant) const {
    const gl::Program* program = state_->programs.find(variant);
    return program == nullptr ? gl::ActiveResources{} : gl::activeResources(*program);
}

GpuMemory Renderer::gpuMemory() const {
    return {state_->textures.volumeBytes(), state_->textures.skipBytes(),
            state_->textures.tableBytes() + state_->layer.bytes() + state_->counters.bytes() +
                static_cast<std::int64_t>(kMaxOutlines * sizeof(glm::vec4) + sizeof(FrameBlock))};
}

void Renderer::contextLost() {
    state_->textures.forget();
    if (state_->builder) {
        state_->builder->forget();
        state_->builder.reset();
    }
    state_->drawer.forget();
    state_->compositor.forget();
    state_->marks.forget();
    state_->layer.forget();
    state_->counters.forget();
    state_->programs.forget();
    state_->created = false;
}

} // namespace slabcast

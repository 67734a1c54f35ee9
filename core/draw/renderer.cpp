#include "core/draw/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/draw/prepare_check.h"
#include "core/draw/renderer_state.h"
#include "core/gl/api.h"

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

Result<void> Renderer::State::createFixed(gl::StateScope& state) {
    if (created) {
        return {};
    }
    state.touch();
    drawer.create();
    created = true;
    return {};
}

Result<const gl::Program*> Renderer::State::needProgram(const ShaderVariant& variant,
                                                        gl::StateScope& state) {
    if (const gl::Program* known = programs.find(variant)) {
        return known;
    }
    state.touch();
    return programs.need(variant);
}

Result<void> Renderer::State::needPrograms(const Scene& scene, const FramePlan& plan,
                                           std::span<const ViewTarget> views,
                                           gl::StateScope& state) {
    constexpr double kNear = 2.0; // radii: an eye that is so near may be inside a moment later
    const auto mayBeCut = [&](const ViewTarget& target) {
        const RayFrame frame =
            makeRayFrame(target.view, target.viewport, scene.geometry(), plan.lattice);
        return frame.sphereDistance < kNear * frame.radius ||
               variantFor(plan, frame, target.view.frustum) != plan.variant;
    };
    const bool opens = plan.variant.interval == Interval::None;
    if (opens && (views.empty() || std::any_of(views.begin(), views.end(), mayBeCut))) {
        if (const auto cut = needProgram(cutVariant(plan), state); !cut) {
            return tl::unexpected(cut.error());
        }
    }
    const Result<const gl::Program*> own = needProgram(plan.variant, state);
    return own ? Result<void>{} : tl::unexpected(own.error());
}

Result<void> Renderer::State::needMarks(const FramePlan& plan, gl::StateScope& state) {
    if (plan.planesPerMark == 0 || marks.exist()) {
        return {};
    }
    state.touch();
    return marks.create();
}

ShaderVariant Renderer::State::stage(std::size_t index, const Scene& scene, const FramePlan& plan,
                                     const View& view, const Viewport& viewport) {
    const RayFrame frame = makeRayFrame(view, viewport, scene.geometry(), plan.lattice);
    if (plan.tighten) {
        tightStack(frame, view.frustum, view.viewFromModel * scene.geometry().modelFromUvw(),
                   boxes.boxes(), plan.planes, plan.layersPerPlane, stack);
    } else {
        sphereStack(frame, view.frustum, plan.planes, plan.layersPerPlane, stack);
    }
    drawer.stage(index, makeFrameBlock(frame, scene, plan, textures.tableWidth()), stack,
                 view.frustum, plan.tighten);
    return variantFor(plan, frame, view.frustum);
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(const Device& device, HostState hostState) {
    return create(device, {}, hostState);
}

Result<Renderer> Renderer::create(const Device& device, const MeasuringText& measuring,
                                  HostState hostState) {
    auto state = std::make_unique<State>(device);
    state->programs = ProgramCache(measuring);
    state->hostState = hostState;
    gl::StateScope scope(hostState);
    if (Result<void> done = state->createFixed(scope); !done) {
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
    gl::StateScope scope(state_->hostState);
    scope.touch();
    if (!state_->builder) {
        Result<GpuSkipBuilder> made = GpuSkipBuilder::create(state_->caps);
        if (!made) {
            return tl::unexpected(made.error());
        }
        state_->builder = std::move(*made);
    }
    const bool pre = scene.classified() != nullptr;
    const Result<GLuint> volume = state_->textures.volumeTexture(scene, pre, state_->caps, scope);
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
    gl::StateScope scope(state_->hostState);
    if (plan.drawsNothing) {
        if (scene.live() == nullptr) { // else the TF may be another one in the next frame
            state_->layer = {};
            state_->counters = {};
        }
        return state_->textures.update(scene, plan, state_->caps, scope);
    }
    return state_->createFixed(scope)
        .and_then([&] { return state_->textures.update(scene, plan, state_->caps, scope); })
        .and_then([&] { return state_->needMarks(plan, scope); })
        .and_then([&] { return state_->needPrograms(scene, plan, views, scope); })
        .and_then([&] { return state_->prepareViews(scene, plan, views, scope); });
}

Result<void> Renderer::State::prepareViews(const Scene& scene, const FramePlan& plan,
                                           std::span<const ViewTarget> views,
                                           gl::StateScope& state) {
    drawer.reserve(views.size());
    drawing.resize(std::max(drawing.size(), views.size()));
    stack.outlines.reserve(static_cast<std::size_t>(plan.planes));
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
            if (!compositor.exists()) {
                state.touch();
                if (Result<void> made = compositor.create(); !made) {
                    return made;
                }
            }
        }
        if (target.layer && !ofLayers) {
            state.touch();
            ofLayers = gl::Framebuffer::make("layers of the host's");
        }
    }
    if (plan.tighten && longest > 0.0) {
        SLABCAST_EXPECTS(scene.skip().exists(), plan.tighten);
        boxes.prepare(scene, longest);
    }
    return layerSize.x > 0 ? resizeLayer(scene, plan, layerSize, state) : Result<void>{};
}

bool Renderer::State::servesView(const Scene& scene, const FramePlan& plan,
                                 const ViewTarget& target) const {
    const Viewport& v = target.viewport;
    const bool tightened =
        !plan.tighten || boxes.serve(scene, longestLayerMm(plan, target.view.frustum));
    const bool layered =
        !needsLayer(plan, target.encoding) ||
        layer.holds(v.width, v.height, glFormat(plan.target), plan.planesPerMark > 0);
    return tightened && layered && (!target.layer || ofLayers);
}

/// Only ever grows: views of different sizes share it without a new one in every frame.
Result<void> Renderer::State::resizeLayer(const Scene& scene, const FramePlan& plan,
                                          glm::ivec2 size, gl::StateScope& state) {
    const std::array formats{glFormat(plan.target), static_cast<GLenum>(GL_DEPTH_COMPONENT16)};
    // TFs that need marks and others that do not share it while the scene is edited.
    const bool depth = plan.planesPerMark > 0 || (scene.live() != nullptr && layer.hasDepth());
    const std::span needed(formats.data(), depth ? 2 : 1);
    const glm::ivec2 most = glm::max(size, glm::ivec2(layer.width(), layer.height()));
    if (layer.is(most.x, most.y, needed)) {
        return {};
    }
    state.touch();
    return layer.resize(most.x, most.y, needed);
}

void Renderer::State::drawRun(const gl::ColorTargets& into, const FramePlan& plan, glm::ivec2 size,
                              const gl::Program& program, const StackShape& shape,
                              const PlaneRun& run) const {
    gl::BindFramebuffer(GL_FRAMEBUFFER, into.framebuffer());
    gl::Viewport(0, 0, size.x, size.y);
    if (plan.planesPerMark > 0) {
        SaturationMarks::useForPlanes();
    }
    program.use();
    drawer.draw(program, shape, run);
}

void Renderer::State::mark(const gl::ColorTargets& marked, const FramePlan& plan,
                           glm::ivec2 size) const {
    marks.mark(layer.texture(0), marked.depth(), size, saturatedAlpha(plan));
}

void Renderer::State::useTarget(const ViewTarget& target) const {
    const Viewport& v = target.viewport;
    gl::BindFramebuffer(GL_FRAMEBUFFER, target.layer ? ofLayers.id() : target.framebuffer);
    if (target.layer) {
        gl::FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target.layer->texture,
                                    target.layer->level, target.layer->layer);
    }
    gl::Viewport(v.x, v.y, v.width, v.height);
}

void Renderer::State::leaveTarget(const ViewTarget& target) {
    if (target.layer) {
        gl::FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, 0, 0, 0);
    }
}

void Renderer::State::drawDirectly(std::size_t view, const ViewTarget& target,
                                   const FramePlan& plan, const gl::Program& program) const {
    useTarget(target);
    const StackShape& shape = drawer.begin(view);
    PlaneRun run;
    for (PlaneRuns runs(plan.order, shape, 0); runs.next(run);) {
        drawer.draw(program, shape, run);
    }
    leaveTarget(target);
}

void Renderer::State::drawLayer(std::size_t view, const ViewTarget& target, const FramePlan& plan,
                                const gl::Program& program, BlendSwitch& blending) const {
    const Viewport& v = target.viewport;
    const glm::ivec2 size(v.width, v.height);
    blending.to(planeBlending(plan));
    layer.clear();
    gl::Viewport(0, 0, size.x, size.y);
    if (plan.planesPerMark > 0) {
        SaturationMarks::useForPlanes();
    }
    program.use();
    const StackShape& shape = drawer.begin(view);
    PlaneRun run;
    bool first = true;
    for (PlaneRuns runs(plan.order, shape, plan.planesPerMark); runs.next(run); first = false) {
        if (first) {
            drawer.draw(program, shape, run);
        } else {
            mark(layer, plan, size);
            drawRun(layer, plan, size, program, shape, run);
        }
    }
    layer.dropDepth();
    if (plan.planesPerMark > 0) {
        gl::Disable(GL_DEPTH_TEST);
    }
    blending.to(kOver);
    useTarget(target);
    compositor.composite(layer.texture(0), v.x, v.y, conversionTo(plan.space, target.encoding));
    leaveTarget(target);
}

Result<void> Renderer::draw(const Scene& scene, const FramePlan& plan,
                            std::span<const ViewTarget> views) {
    if (Result<void> ok = checkPlan(plan, scene).and_then([&] { return checkViews(views); }); !ok) {
        return ok;
    }
    if (plan.drawsNothing) {
        return {};
    }
    if (state_->programs.find(plan.variant) == nullptr || !state_->textures.serve(scene, plan)) {
        return fail(ErrorCode::InvalidArgument,
                    "scene and plan were not prepared: call prepare() with them first");
    }
    const auto served = [&](const ViewTarget& target) {
        return isEmpty(target.viewport) || state_->servesView(scene, plan, target);
    };
    if (views.size() > state_->drawer.views() || !std::all_of(views.begin(), views.end(), served)) {
        return fail(ErrorCode::InvalidArgument,
                    "a view is larger or wider than those that were prepared, its target is "
                    "encoded otherwise or a layer, or there are more: prepare() with these views "
                    "first");
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ViewTarget& target = views[i];
        const Viewport& v = target.viewport;
        if (!isEmpty(v)) {
            const bool layered = needsLayer(plan, target.encoding);
            state_->drawing[i] = state_->programs.find(state_->stage(
                i, scene, plan, target.view, layered ? Viewport{0, 0, v.width, v.height} : v));
            if (state_->drawing[i] == nullptr) {
                return fail(ErrorCode::InvalidArgument,
                            "a view's eye or near plane is nearer to the volume than those that "
                            "were prepared: prepare() with these views first");
            }
        }
    }
    gl::StateScope scope(state_->hostState);
    scope.touch();
    state_->drawer.upload(views.size());
    BlendSwitch blending(planeBlending(plan));
    state_->textures.bind(scene.skip());
    state_->drawer.useVertices();
    const gl::Program* inUse = nullptr; // and the blending of planes
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ViewTarget& target = views[i];
        if (isEmpty(target.viewport)) {
            continue;
        }
        if (needsLayer(plan, target.encoding)) {
            state_->drawLayer(i, target, plan, *state_->drawing[i], blending);
            inUse = nullptr;
            continue;
        }
        if (inUse != state_->drawing[i]) {
            inUse = state_->drawing[i];
            inUse->use();
            blending.to(planeBlending(plan));
        }
        state_->drawDirectly(i, target, plan, *inUse);
    }
    return {};
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
                state_->drawer.bytes()};
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
    state_->ofLayers.forget();
    state_->programs.forget();
    state_->created = false;
}

} // namespace slabcast

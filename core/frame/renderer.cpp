#include "core/frame/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/frame/gpu_scene.h"
#include "core/frame/layer_compositor.h"
#include "core/frame/stack_drawer.h"
#include "core/gl/api.h"
#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

GLenum glFormat(TargetFormat format) {
    return format == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
}

/// A plan is for one look: its variant says how the texels are classified, lit and blended.
bool fits(const FramePlan& plan, const Look& look) {
    return plan.variant.classification == look.classification && plan.space == look.space &&
           (look.shading.has_value() || !plan.variant.shaded);
}

/// The framebuffer may be blended into directly where it holds what is composited.
bool needsLayer(CompositingSpace space, TargetEncoding encoding) {
    return !(space == CompositingSpace::Display && encoding == TargetEncoding::Encoded) &&
           !(space == CompositingSpace::Linear && encoding == TargetEncoding::Linear);
}

LayerConversion conversionTo(CompositingSpace space, TargetEncoding encoding) {
    if (space == CompositingSpace::Display) {
        return LayerConversion::Decode; // a linear target, or an sRGB format that encodes by itself
    }
    return encoding == TargetEncoding::Encoded ? LayerConversion::Encode : LayerConversion::None;
}

void setBlending(GLenum source, GLenum destination) {
    for (const GLenum off : {GL_CULL_FACE, GL_DEPTH_TEST, GL_DITHER, GL_RASTERIZER_DISCARD,
                             GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK,
                             GL_SCISSOR_TEST, GL_STENCIL_TEST}) {
        gl::Disable(off);
    }
    gl::DepthMask(GL_FALSE);
    gl::ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl::Enable(GL_BLEND);
    gl::BlendEquation(GL_FUNC_ADD);
    gl::BlendFunc(source, destination);
}

std::vector<VisibleBox> visibleBoxesOf(const Scene& scene, double layerLengthMm) {
    const BuiltSkip& skip = scene.skip();
    return visibleBoxes(*skip.lengths, scene.geometry(), layerLengthMm);
}

} // namespace

struct Renderer::State {
    gl::Caps caps;
    GpuScene textures;
    StackDrawer drawer;
    LayerCompositor compositor;
    gl::ColorTargets layer, counters;
    bool created = false; // the objects that do not depend on a scene
    std::map<ShaderVariant, gl::Program> programs;
    // What visible boxes were made for.
    int boxesOfLook = -1;
    double boxesOfLengthMm = 0.0;
    std::vector<VisibleBox> boxes;

    Result<void> createFixed();
    Result<const gl::Program*> program(const ShaderVariant& variant);
    void updateBoxes(const Scene& scene, double layerLengthMm);
    void drawStack(const Scene& scene, const FramePlan& plan, const View& view,
                   const Viewport& viewport, const gl::Program& program);
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

Result<const gl::Program*> Renderer::State::program(const ShaderVariant& variant) {
    const auto known = programs.find(variant);
    if (known != programs.end()) {
        return &known->second;
    }
    const Result<ShaderPair> text = shaderText(variant);
    if (!text) {
        return tl::unexpected(text.error());
    }
    Result<gl::Program> built =
        gl::buildProgram(slabcast::name(variant), text->vertex, text->fragment);
    if (!built) {
        return tl::unexpected(built.error());
    }
    StackDrawer::connect(*built);
    return &programs.emplace(variant, std::move(*built)).first->second;
}

void Renderer::State::updateBoxes(const Scene& scene, double layerLengthMm) {
    // Rounded up to a power of two: views of slightly different width share their boxes.
    const double length = std::exp2(std::ceil(std::log2(layerLengthMm)));
    if (boxesOfLook == scene.lookGeneration() && boxesOfLengthMm == length) {
        return;
    }
    boxes = visibleBoxesOf(scene, length);
    boxesOfLook = scene.lookGeneration();
    boxesOfLengthMm = length;
}

void Renderer::State::drawStack(const Scene& scene, const FramePlan& plan, const View& view,
                                const Viewport& viewport, const gl::Program& program) {
    const RayFrame frame = makeRayFrame(view, viewport, scene.geometry(), plan.lattice);
    SLABCAST_EXPECTS(!plan.tighten || scene.skip().exists(), plan.tighten);
    ProxyStack stack;
    if (plan.tighten) {
        const Frustum& f = view.frustum;
        const glm::dvec2 widest(std::max(std::abs(f.left), std::abs(f.right)),
                                std::max(std::abs(f.bottom), std::abs(f.top)));
        updateBoxes(scene, plan.lattice.spacingMm * std::sqrt(1.0 + glm::dot(widest, widest)));
        stack = tightStack(frame, f, view.viewFromModel * scene.geometry().modelFromUvw(), boxes,
                           plan.planes, plan.layersPerPlane);
    } else {
        stack = sphereStack(frame, view.frustum, plan.planes, plan.layersPerPlane);
    }
    program.use();
    textures.bind();
    drawer.draw(makeFrameBlock(frame, scene, plan), stack, view.frustum, plan.tighten);
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(const gl::Caps& caps) {
    auto state = std::make_unique<State>();
    state->caps = caps;
    const gl::StateGuard guard;
    if (Result<void> done = state->createFixed(); !done) {
        return tl::unexpected(done.error());
    }
    return Renderer(std::move(state));
}

Result<void> Renderer::prepare(const Scene& scene, const FramePlan& plan) {
    if (plan.drawsNothing) {
        const gl::StateGuard guard;
        state_->layer = {};
        state_->counters = {};
        return state_->textures.update(scene, plan, state_->caps);
    }
    if (!fits(plan, scene.look())) {
        return fail(ErrorCode::InvalidArgument,
                    "plan and look differ in classification, shading or space: set a look for the "
                    "settings that the plan was made from");
    }
    const gl::StateGuard guard;
    if (Result<void> done = state_->createFixed(); !done) {
        return done;
    }
    if (Result<void> done = state_->textures.update(scene, plan, state_->caps); !done) {
        return done;
    }
    const Result<const gl::Program*> program = state_->program(plan.variant);
    return program ? Result<void>{} : tl::unexpected(program.error());
}

Result<void> Renderer::draw(const Scene& scene, const FramePlan& plan,
                            std::span<const ViewTarget> views) {
    if (plan.drawsNothing) {
        return {};
    }
    const gl::StateGuard guard;
    const auto program = state_->programs.find(plan.variant);
    SLABCAST_EXPECTS(program != state_->programs.end(), plan.variant.unroll);
    SLABCAST_EXPECTS(state_->textures.serve(scene, plan), scene.lookGeneration());
    for (const ViewTarget& target : views) {
        const Viewport& v = target.viewport;
        if (v.width <= 0 || v.height <= 0) {
            continue; // a window made small
        }
        setBlending(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        if (!needsLayer(plan.space, target.encoding)) {
            gl::BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
            gl::Viewport(v.x, v.y, v.width, v.height);
            state_->drawStack(scene, plan, target.view, v, program->second);
            continue;
        }
        // Only ever grows: views of different sizes share it without a new one in every frame.
        gl::ColorTargets& layer = state_->layer;
        if (Result<void> done =
                layer.resize(std::max(v.width, layer.width()), std::max(v.height, layer.height()),
                             {glFormat(plan.target)});
            !done) {
            return done;
        }
        layer.begin();
        gl::Viewport(0, 0, v.width, v.height);
        state_->drawStack(scene, plan, target.view, {0, 0, v.width, v.height}, program->second);
        gl::BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        gl::Viewport(v.x, v.y, v.width, v.height);
        state_->compositor.composite(layer.texture(0), v.x, v.y,
                                     conversionTo(plan.space, target.encoding));
    }
    return {};
}

Result<WorkCounters> Renderer::countWork(const Scene& scene, const FramePlan& plan,
                                         std::span<const ViewTarget> views) {
    if (!state_->caps.floatBlend) {
        return fail(ErrorCode::DeviceUnsupported,
                    "work cannot be counted on this device: it does not blend float32 "
                    "targets (GL_EXT_float_blend)");
    }
    WorkCounters sums;
    if (plan.drawsNothing) {
        return sums;
    }
    const gl::StateGuard guard;
    ShaderVariant counting = plan.variant;
    counting.counts = true;
    const Result<const gl::Program*> program = state_->program(counting);
    if (!program) {
        return tl::unexpected(program.error());
    }
    for (const ViewTarget& target : views) {
        const int width = target.viewport.width;
        const int height = target.viewport.height;
        if (Result<void> done = state_->counters.resize(width, height, {GL_RGBA32F, GL_RGBA32F});
            !done) {
            return tl::unexpected(done.error());
        }
        setBlending(GL_ONE, GL_ONE);
        state_->counters.begin();
        state_->drawStack(scene, plan, target.view, {0, 0, width, height}, **program);
        std::array<glm::dvec4, 2> total{};
        for (std::size_t k = 0; k < total.size(); ++k) {
            for (const glm::vec4& pixel : state_->counters.read(k)) {
                total[k] += glm::dvec4(pixel);
            }
        }
        sums.fragments += static_cast<std::int64_t>(total[0].x);
        sums.layersEvaluated += static_cast<std::int64_t>(total[0].z);
        sums.layersSkipped += static_cast<std::int64_t>(total[0].y - total[0].z);
        sums.skipFetches += static_cast<std::int64_t>(total[0].w);
        sums.volumeFetches += static_cast<std::int64_t>(total[1].x);
    }
    return sums;
}

double Renderer::compileMs(const ShaderVariant& variant) const {
    const auto found = state_->programs.find(variant);
    return found == state_->programs.end() ? 0.0 : found->second.buildMs();
}

gl::ActiveResources Renderer::resources(const ShaderVariant& variant) const {
    const auto found = state_->programs.find(variant);
    return found == state_->programs.end() ? gl::ActiveResources{}
                                           : gl::activeResources(found->second);
}

GpuMemory Renderer::gpuMemory() const {
    return {state_->textures.volumeBytes(), state_->textures.skipBytes(),
            state_->textures.tableBytes() + state_->layer.bytes() + state_->counters.bytes() +
                static_cast<std::int64_t>(kMaxOutlines * sizeof(glm::vec4) + sizeof(FrameBlock))};
}

void Renderer::contextLost() {
    state_->textures.forget();
    state_->drawer.forget();
    state_->compositor.forget();
    state_->layer.forget();
    state_->counters.forget();
    for (auto& [variant, program] : state_->programs) {
        program.forget();
    }
    state_->programs.clear();
    state_->created = false;
}

} // namespace slabcast

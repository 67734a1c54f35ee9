#pragma once

#include <optional>
#include <span>

#include "core/draw/box_cache.h"
#include "core/draw/layer_compositor.h"
#include "core/draw/plane_blending.h"
#include "core/draw/program_cache.h"
#include "core/draw/renderer.h"
#include "core/draw/saturation_marks.h"
#include "core/draw/stack_drawer.h"
#include "core/gl/color_targets.h"
#include "core/gl/state_guard.h"
#include "core/scene/gpu_scene.h"
#include "core/skip/gpu/gpu_built_skip.h"

namespace slabcast {

/// What a renderer keeps, and the steps that drawing (renderer.cpp) and counting work
/// (work_counting.cpp) share.
struct Renderer::State {
    explicit State(Device its) : device(std::move(its)), caps(device.caps()) {}

    Device device;
    const gl::Caps& caps;
    GpuScene textures;
    StackDrawer drawer;
    LayerCompositor compositor;
    SaturationMarks marks;
    gl::ColorTargets layer, counters;
    gl::Framebuffer ofLayers; // of the host's textures, one at a time; made when first needed
    std::optional<GpuSkipBuilder> builder; // made when it is first needed
    bool created = false;                  // the objects that do not depend on a scene
    HostState hostState = HostState::Restore;
    ProgramCache programs;
    BoxCache boxes;
    ProxyStack stack;                        // of the view that is staged: room
    std::vector<const gl::Program*> drawing; // by view

    Result<void> createFixed(gl::StateScope& state);
    Result<const gl::Program*> needProgram(const ShaderVariant& variant, gl::StateScope& state);
    /// The plan's, and the one that cuts rays' stays where a view may come to need it.
    Result<void> needPrograms(const Scene& scene, const FramePlan& plan,
                              std::span<const ViewTarget> views, gl::StateScope& state);
    Result<void> needMarks(const FramePlan& plan, gl::StateScope& state);
    /// What the views need beside textures and shaders.
    Result<void> prepareViews(const Scene& scene, const FramePlan& plan,
                              std::span<const ViewTarget> views, gl::StateScope& state);
    /// Whether prepareViews() was called for views as large and wide.
    bool servesView(const Scene& scene, const FramePlan& plan, const ViewTarget& target) const;
    /// Stages a view's planes. Returns the variant that draws it.
    ShaderVariant stage(std::size_t index, const Scene& scene, const FramePlan& plan,
                        const View& view, const Viewport& viewport);
    Result<void> resizeLayer(const Scene& scene, const FramePlan& plan, glm::ivec2 size,
                             gl::StateScope& state);
    void drawRun(const gl::ColorTargets& into, const FramePlan& plan, glm::ivec2 size,
                 const gl::Program& program, const StackShape& shape, const PlaneRun& run) const;
    /// Marks what the layer has of saturated pixels in the depth of `marked`.
    void mark(const gl::ColorTargets& marked, const FramePlan& plan, glm::ivec2 size) const;
    /// Makes it what is drawn into. Contract: leaveTarget() follows.
    void useTarget(const ViewTarget& target) const;
    /// No layer stays attached: the host may delete its texture.
    static void leaveTarget(const ViewTarget& target);
    void drawDirectly(std::size_t view, const ViewTarget& target, const FramePlan& plan,
                      const gl::Program& program) const;
    void drawLayer(std::size_t view, const ViewTarget& target, const FramePlan& plan,
                   const gl::Program& program, BlendSwitch& blending) const;
    Result<void> count(const Scene& scene, const FramePlan& plan, const ViewTarget& target,
                       gl::StateScope& state);
};

} // namespace slabcast

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/draw/renderer.h"
#include "core/gl/color_targets.h"
#include "core/scene/scene.h"
#include "perf/volume_info.h"
#include "perf/watcher.h"

namespace slabcast {

/// A volume's look, where it is seen from and what its pictures are drawn into.
struct StageDesc {
    glm::ivec2 size{1024, 1024}; // of the picture, both eyes together
    OrbitCamera camera;
    double fovDegrees = 40.0;
    std::optional<double> stereoIpdMm; // the left half is the left eye's; none: one eye
    std::optional<glm::dvec3> background = glm::dvec3(0.0); // sRGB-encoded; none: transparent

    TransferFunction tf;
    Settings settings; // of which the look takes its part; plans may be of others

    bool exactTexels = false;                   // fetched and interpolated, not filtered
    std::optional<std::int64_t> gpuBudgetBytes; // for the volume's texture
    bool keepValues = false;                    // the volume's own values too, for references
};

/// A scene with its renderer and a framebuffer to draw into: what all measuring is done with. The
/// context that it was opened in must be current at every call and outlive it.
/// Tested by: cli_pictures_test.py
class Stage {
public:
    /// Chooses the texel format, checks that what this classification uploads fits before anything
    /// is allocated on the GPU, builds the scene and applies the look. `statistics`: the volume's.
    /// Fails: VolumeTooLarge, SizeOverflow, EmptyVolume, as Scene::setLook(),
    /// Renderer::provide() and Renderer::create().
    static Result<Stage> open(Device device, Volume volume, const VolumeStatistics& statistics,
                              StageDesc desc, Watcher watcher = {});

    /// Classifies anew, under the same transfer function. Fails: as open().
    Result<void> reclassify(Classification classification);

    /// The scene as it is, under a transfer function and skipping as told, to be shown in its
    /// place: they share the texels.
    Result<Scene> variation(const TransferFunction& tf, const SkipOptions& skip) const;

    /// From here on this one is drawn. Contract: it is a variation.
    void show(Scene scene) { scene_ = std::move(scene); }

    /// Of the picture, from the next prepare() on.
    void resize(glm::ivec2 size) { desc_.size = size; }

    /// What ratios take here, by measureRatios(); nothing where the settings name one, or nothing
    /// is visible. Draws and compiles all of them. Fails: as that.
    Result<std::vector<RatioMeasurement>> timeRatios(const Settings& settings);

    /// The plan, and what it warns of is said. It goes by `measured` where the settings leave the
    /// ratio open, and measures nothing: without, two runs decide alike. Fails: as
    /// slabcast::plan().
    Result<FramePlan> decide(const Settings& settings,
                             std::span<const RatioMeasurement> measured = {}) const;
    /// The same without a word.
    Result<FramePlan> plan(const Settings& settings) const;

    /// Renderer::prepare(), and a framebuffer of the plan's format.
    Result<void> prepare(const FramePlan& plan);

    /// Clears to the background and draws with the volume turned by `turnDegrees`; returns the time
    /// in ms until the GPU has finished.
    Result<double> drawTimed(const FramePlan& plan, double turnDegrees);

    /// Draws on nothing: what is there in the compositing space, premultiplied, rows from the
    /// bottom.
    Result<std::vector<glm::dvec4>> drawOnNothing(const FramePlan& plan);

    Result<WorkCounters> countWork(const FramePlan& plan);
    /// The same of every pixel of the picture, both eyes where there are two, top row first.
    Result<std::vector<PixelWork>> workPerPixel(const FramePlan& plan);

    /// The picture, top row first, over the background: sRGB-encoded if `encoded`, else light.
    /// Alpha 1 unless the background is transparent, then not premultiplied if encoded.
    std::vector<glm::vec4> picture(bool encoded) const;

    /// Where each eye looks, and its place in the picture.
    std::vector<ViewTarget> views(double turnDegrees) const;

    const StageDesc& desc() const { return desc_; }
    const Device& device() const { return device_; }
    const gl::Caps& caps() const { return device_.caps(); }
    const Watcher& watcher() const { return watcher_; }
    const Scene& scene() const { return scene_; }
    const VolumeInfo& info() const { return info_; }
    /// What the texture unit's filter may add to a sample of the scene, in sampled units.
    double filterErrorSampled() const;
    /// The volume's own values. Contract: StageDesc::keepValues.
    const Texels& values() const { return values_ ? *values_ : scene_.texels(); }
    Renderer& renderer() { return renderer_; }
    const Renderer& renderer() const { return renderer_; }

private:
    Stage(Device device, StageDesc desc, Watcher watcher, Scene scene, Renderer renderer)
        : device_(std::move(device)), desc_(std::move(desc)), watcher_(std::move(watcher)),
          scene_(std::move(scene)), renderer_(std::move(renderer)) {}

    Result<void> setLook(TransferFunction tf, Classification classification);
    Result<double> drawOn(glm::vec4 clear, const FramePlan& plan, double turnDegrees);

    Device device_;
    StageDesc desc_;
    Watcher watcher_;
    Scene scene_;
    VolumeInfo info_;
    std::optional<Texels> values_; // where they are to be kept and the scene's texels round them
    Renderer renderer_;
    gl::ColorTargets target_;
    CompositingSpace space_ = CompositingSpace::Display;
};

} // namespace slabcast

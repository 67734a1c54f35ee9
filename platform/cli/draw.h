#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "core/gl/color_targets.h"
#include "platform/cli/options.h"

namespace slabcast {

/// A scene with its renderer and a framebuffer to draw into: what render and sweep share.
class Stage {
public:
    /// Opens device and volume, applies the look.
    static Result<Stage> open(const SceneOptions& options);

    /// Classifies anew, under the same transfer function.
    Result<void> reclassify(Classification classification);

    /// The scene as it is, under a transfer function and skipping as told, to be shown in its
    /// place: they share the texels.
    Result<Scene> variation(const TransferFunction& tf, const SkipOptions& skip) const;

    /// From here on this one is drawn. Contract: it is a variation.
    void show(Scene scene) { loaded_.scene = std::move(scene); }

    /// Of the picture, from the next prepare() on.
    void resize(glm::ivec2 size) { options_.size = size; }

    /// Decides the plan; measures ratios first where the settings leave the ratio open.
    Result<FramePlan> decide(const Settings& settings);

    /// prepare(), the framebuffer of the plan's format included.
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

    const Scene& scene() const { return loaded_.scene; }
    const VolumeInfo& info() const { return loaded_.info; }
    /// The volume's own values. Contract: InputOptions::keepValues.
    const Texels& values() const { return *loaded_.values; }
    const Session& session() const { return session_; }
    Renderer& renderer() { return renderer_; }

private:
    Stage(SceneOptions options, Session session, LoadedScene loaded, Renderer renderer)
        : options_(std::move(options)), session_(std::move(session)), loaded_(std::move(loaded)),
          renderer_(std::move(renderer)) {}

    Result<void> setLook(TransferFunction tf, Classification classification);
    int maxTableSize() const;
    Result<double> drawOn(glm::vec4 clear, const FramePlan& plan, double turnDegrees);

    SceneOptions options_;
    Session session_;
    LoadedScene loaded_;
    Renderer renderer_;
    gl::ColorTargets target_;
    CompositingSpace space_ = CompositingSpace::Display;
};

struct FrameTimes {
    double median = 0.0, min = 0.0, max = 0.0, p10 = 0.0, p90 = 0.0;
    int count = 0;
};

FrameTimes summarise(std::vector<double> milliseconds);

// JSON fragments that reports share. Keys are stable: people plot them.
nlohmann::json toJson(const gl::Caps& caps);
nlohmann::json toJson(const VolumeInfo& info);
nlohmann::json toJson(const FramePlan& plan);
nlohmann::json toJson(const FrameTimes& times);              // null of none
nlohmann::json toJson(const Result<WorkCounters>& counters); // null where they cannot be had
std::string commit(); // that was built; defined in a source that the build writes

} // namespace slabcast

#pragma once

#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/draw/renderer.h"
#include "core/gl/color_targets.h"
#include "core/scene/texel_format.h"
#include "perf/stability/appearance.h"
#include "perf/stability/case.h"
#include "perf/stability/families.h"

namespace slabcast::stability {

/// A way to draw: the same samples, dealt out to planes differently, into a target.
struct Method {
    const char* name; // "slicing, rgba8"
    int layersPerPlane;
    TargetFormat target;
};

/// Slicing, hybrid (16 layers per plane) and ray casting, into both targets.
std::span<const Method> methods();

/// More layers per plane than there are: one plane.
inline constexpr int kAllLayers = 1 << 20;

/// The method's settings: nothing skipped or left early, one voxel per layer, to be changed as a
/// case needs.
Settings settingsOf(const Method& method);

View orbitView(const Scene& scene, const OrbitCamera& camera, double fovDegrees, glm::ivec2 size);

struct Drawn {
    FramePlan plan;
    Picture picture;
};

/// What all cases draw with, and where they are written down. One GL context, current throughout.
class Bench {
public:
    Bench(Renderer& renderer, Device device, bool reduced)
        : renderer_(renderer), device_(std::move(device)), reduced_(reduced) {}

    /// Fewer sizes, views and repetitions, for test runs. Bounds are never others.
    bool reduced() const { return reduced_; }

    /// Texel format as the renderer would choose it for this device.
    Result<Scene> scene(const Volume& volume, const Appearance& appearance,
                        const SkipOptions& skip = {}, bool exact = false) const;
    Result<FramePlan> plan(const Scene& scene, const Settings& settings) const;
    /// Into a target of the plan's format, cleared to transparent black.
    Result<Drawn> draw(const Scene& scene, const Settings& settings, const View& view,
                       glm::ivec2 size);
    Result<Drawn> draw(const Scene& scene, const FramePlan& plan, const View& view,
                       glm::ivec2 size);
    /// Into float32, so that no target's rounding hides what was computed; into fp16 where a device
    /// does not blend that. Contract: a plan for fp16.
    struct FinestTarget {
        const char* name;
        double rounding; // of values up to 1
    };
    FinestTarget finest() const;
    Result<Picture> drawFinely(const Scene& scene, const FramePlan& plan, const View& view,
                               glm::ivec2 size);
    Result<WorkCounters> countWork(const Scene& scene, const FramePlan& plan, const View& view,
                                   glm::ivec2 size);

    /// Contract: no other case has this name. One that could not fail does: it claims nothing.
    void record(Case measured);
    /// A case that could not be measured: it fails, with the error as the reason.
    void recordFailure(Case unmeasured, const Error& error);
    /// Either of the two.
    void record(Case c, const Result<double>& measured);
    /// Draws, lets `judge` fill in bound and measured value, and records. The plan is pure: a bound
    /// made from it is one that was known before.
    void examine(Case c, const Scene& scene, const Settings& settings, const View& view,
                 glm::ivec2 size, const std::function<void(Case& c, const Drawn& drawn)>& judge);
    /// Hears of every case as it is recorded.
    void setWatcher(std::function<void(const Case&)> watcher) { watcher_ = std::move(watcher); }

    const std::vector<Case>& cases() const { return cases_; }
    const Device& device() const { return device_; }
    const gl::Caps& caps() const { return device_.caps(); }
    Renderer& renderer() { return renderer_; }

private:
    Renderer& renderer_;
    Device device_;
    bool reduced_;
    gl::ColorTargets target_;
    std::vector<Case> cases_;
    std::set<std::string> names_;
    std::function<void(const Case&)> watcher_;
};

/// Into a float32 target of its own. Contract: the device blends them.
Result<Picture> drawInFloat32(Renderer& renderer, const Scene& scene, const FramePlan& plan,
                              const View& view, glm::ivec2 size);

// Quantities that cases measure.

/// The greater of two; NaN stays.
double largerOf(double largest, double next);
/// Largest difference of any component. NaN where there is one.
double largestDifference(const Picture& picture, std::span<const glm::dvec4> reference);

/// The integral without any sampling, of the scene's texels under its TF (core/reference).
std::vector<glm::dvec4> continuousPicture(const Scene& scene, const View& view, glm::ivec2 size);

/// The renderer against float64 evaluation of the very samples that it takes: worst share of the
/// pixel's own bound (reference_picture.h: filter, float32 positions, table; and the blending's)
/// that is used up. 1 is the bound. Pixels whose rays graze the box are left out.
double shareOfPixelBound(const Scene& scene, const Drawn& drawn, const View& view);
/// The reason that goes with it.
extern const char* const kPixelBoundReason;

} // namespace slabcast::stability

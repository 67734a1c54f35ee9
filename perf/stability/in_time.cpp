#include <algorithm>

#include "core/base/parallel.h"
#include "core/gl/api.h"
#include "core/volume/phantoms.h"
#include "perf/stability/bench.h"
#include "perf/stability/reference_picture.h"
#include "perf/stability/sampling_bound.h"
#include "perf/stability/swimming.h"
#include "perf/stability/turning.h"

namespace slabcast::stability {

namespace {

/// A view of one pixel whose ray has the tangent `straight` in a view that looks at the volume.
View viewAlong(const Scene& scene, glm::dvec2 straight, double turnedDegrees) {
    View view = headTurned(scene, turnedDegrees);
    const glm::dvec3 direction = headTurn(turnedDegrees) * glm::dvec3(straight, -1.0);
    const glm::dvec2 tangent = glm::dvec2(direction) / -direction.z;
    constexpr double kWidth = 1e-3;
    view.frustum = {tangent.x - kWidth, tangent.x + kWidth, tangent.y - kWidth, tangent.y + kWidth};
    return view;
}

const char* const kSameRayReason =
    "a head that turns leaves every world ray where it is, and its integral with it; the lattice "
    "moves the samples along the ray (planar: to the same view depths; shells: not at all, but for "
    "the 2^-44 of the distance that rounding takes). No layer changes the pixel by more than the "
    "transmittance before it times the material's range along that way; and no two sums differ by "
    "more than both of their distances from the integral. The smaller of the two, RMS over rays";
const char* const kDeviceReason =
    "; a device adds, in either view, its arithmetic and one rounding of the target";

/// Rays through the volume that stay in the world while the head turns, on one lattice.
class SameRays {
public:
    SameRays(Bench& bench, const Scene& scene, const TurningScene& setup, const Settings& settings)
        : bench_(bench), scene_(scene), setup_(setup), settings_(settings),
          side_(bench.reduced() ? 6 : 20) {}

    Result<void> run() {
        const Result<FramePlan> plan = bench_.plan(scene_, settings_);
        if (!plan) {
            return tl::unexpected(plan.error());
        }
        const Frame before = sampled(*plan, 0.0);
        const Result<Pixels> drawnBefore = drawn(*plan, 0.0);
        const double ofDevice = 2.0 * deviceBound(*plan);
        for (const double degrees : turnedDegrees(bench_.reduced())) {
            const Frame after = sampled(*plan, degrees);
            const Result<Pixels> drawnAfter = drawn(*plan, degrees);
            if (!drawnBefore || !drawnAfter) {
                return tl::unexpected(drawnBefore ? drawnAfter.error() : drawnBefore.error());
            }
            using enum SamplingBound::By;
            record(*plan, "float64", degrees, rms(before.pixels, after.pixels),
                   bound(*plan, before, after, Transfer), kSameRayReason);
            record(*plan, "drawn", degrees, rms(*drawnBefore, *drawnAfter),
                   bound(*plan, before, after, Table) + ofDevice,
                   std::string(kSameRayReason) + kDeviceReason);
        }
        return {};
    }

private:
    using Pixels = std::vector<glm::dvec4>;
    struct Frame {
        Pixels pixels;
        std::vector<EyeRay> rays;
    };

    View viewOf(int ray, double degrees) const {
        const glm::dvec2 share = (glm::dvec2(ray % side_, ray / side_) + 0.5) / double(side_);
        return viewAlong(scene_, (share * 2.0 - 1.0) * halfWindow(), degrees);
    }

    Frame sampled(const FramePlan& plan, double degrees) const {
        const auto count = static_cast<std::size_t>(side_) * side_;
        Frame frame{Pixels(count), std::vector<EyeRay>(count)};
        parallelFor(std::int64_t(count), side_, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                const DiscreteInput input =
                    samplesOf(scene_, viewOf(int(i), degrees), glm::ivec2(1), plan.lattice);
                frame.pixels[std::size_t(i)] = renderDiscrete(input).front();
                frame.rays[std::size_t(i)] =
                    eyeRayOf(input.view, input.viewport, input.geometry, glm::dvec2(0.5));
            }
        });
        return frame;
    }

    /// Every ray as a view of its own, of one pixel.
    Result<Pixels> drawn(const FramePlan& plan, double degrees) {
        if (Result<void> made = target_.resize(side_, side_, {GL_RGBA16F}); !made) {
            return tl::unexpected(made.error());
        }
        target_.begin();
        std::vector<ViewTarget> views;
        for (int i = 0; i < side_ * side_; ++i) {
            views.push_back(
                {viewOf(i, degrees), target_.framebuffer(), {i % side_, i / side_, 1, 1}});
        }
        if (Result<void> ready = bench_.renderer().prepare(scene_, plan, views); !ready) {
            return tl::unexpected(ready.error());
        }
        if (Result<void> done = bench_.renderer().draw(scene_, plan, views); !done) {
            return tl::unexpected(done.error());
        }
        const std::vector<glm::vec4> pixels = target_.read();
        return Pixels(pixels.begin(), pixels.end());
    }

    static double rms(const Pixels& before, const Pixels& after) {
        SquareSum changes;
        for (std::size_t i = 0; i < before.size(); ++i) {
            changes.add(largest(after[i] - before[i]));
        }
        return changes.rms();
    }

    double bound(const FramePlan& plan, const Frame& before, const Frame& after,
                 SamplingBound::By by) const {
        const SamplingBound bound(scene_, by);
        SquareSum bounds;
        for (std::size_t i = 0; i < before.rays.size(); ++i) {
            bounds.add(std::min(bound.ofSampling(before.rays[i], plan.lattice, 0.0) +
                                    bound.ofSampling(after.rays[i], plan.lattice, 0.0),
                                bound.ofMotion(before.rays[i], after.rays[i], plan.lattice)));
        }
        return bounds.rms();
    }

    /// The largest of any pixel of a picture of the same window.
    double deviceBound(const FramePlan& plan) const {
        const ReferencePicture reference(scene_, plan, headTurned(scene_, 0.0),
                                         {0, 0, side_, side_});
        double worst = 0.0;
        for (int i = 0; i < side_ * side_; ++i) {
            const PixelReference pixel = reference.at(glm::dvec2(i % side_, i / side_) + 0.5);
            worst = std::max(worst, pixel.atEdge ? 0.0 : pixel.bound);
        }
        return worst + blendingBound(plan);
    }

    void record(const FramePlan& plan, const char* how, double degrees, double measured,
                double bound, std::string reason) {
        const std::string what = named(
            {name(plan.lattice.kind), number(plan.lattice.spacingMm) + " voxels per layer", how});
        bench_.record(
            {.family = "in-time",
             .name = named({"same rays", setup_.name, what, number(degrees) + " degrees"}),
             .quantity = "RMS change of a world ray's pixel, of full scale",
             .bound = bound,
             .reason = std::move(reason),
             .measured = measured,
             .series = Series{.group = what,
                              .panel = named({"head turn, same world rays", setup_.name}),
                              .x = degrees,
                              .y = measured,
                              .xLabel = kTurnedLabel,
                              .yLabel = "RMS change of the error"}});
    }

    Bench& bench_;
    const Scene& scene_;
    const TurningScene& setup_;
    Settings settings_;
    int side_;
    gl::ColorTargets target_;
};

void sameRayCases(Bench& bench, const Scene& scene, const TurningScene& setup) {
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const double spacing : {1.0, 4.0}) {
            Settings settings = settingsOf(methods().back()); // ray casting into fp16
            settings.lattice = kind;
            settings.layerSpacingVoxels = spacing;
            if (Result<void> done = SameRays(bench, scene, setup, settings).run(); !done) {
                bench.recordFailure(
                    {.family = "in-time",
                     .name = named({"same rays", setup.name, name(kind), number(spacing)})},
                    done.error());
            }
        }
    }
}

} // namespace

void inTimeCases(Bench& bench) {
    for (const TurningScene& setup : turningScenes()) {
        const Result<Volume> volume = makePhantom(setup.phantom);
        SLABCAST_EXPECTS(volume.has_value(), 48);
        const Result<Scene> scene =
            bench.scene(*volume, {.tf = setup.tf}, {SkipStructure::None}, true);
        if (!scene) {
            bench.recordFailure({.family = "in-time", .name = setup.name}, scene.error());
            continue;
        }
        sameRayCases(bench, *scene, setup);
        for (const Motion& motion : kMotions) {
            swimmingCases(bench, *scene, setup, motion);
        }
    }
}

} // namespace slabcast::stability

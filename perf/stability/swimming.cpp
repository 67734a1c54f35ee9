#include "perf/stability/swimming.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/reference/continuous.h"
#include "perf/stability/expected.h"
#include "perf/stability/reference_picture.h"
#include "perf/stability/sampling_bound.h"

namespace slabcast::stability {

namespace {

using Pixels = std::vector<glm::dvec4>;

/// What one picture may be from its reference, pixel by pixel.
struct Allowance {
    double sampling;       // by the continuous TF
    double deviceSampling; // by the table
    double arithmetic;
    bool atEdge; // the ray grazes the box
};

const char* const kSwimmingReason =
    "each of the two pictures is within its own error of its integral: that of sampling (a layer's "
    "material in its middle against its extremes in the layer, weighted by the transmittance "
    "before it), and on a device those of its arithmetic, the table and one rounding of the target "
    "per plane that the ray meets. Each integral is along its own picture's rays, which a head "
    "turn leaves in place "
    "to "
    "a fifth of a pixel. RMS over pixels";

const char* const kRatioReason =
    "the ratio moves no sample: what is left is one rounding of the target per plane that the ray "
    "meets, of either, in both views, and the order in which float32 sums (under 100 layers of "
    "2^-24, twice). RMS over pixels and views";

/// A view that turns in steps, and what it should show; the first is before anything turned.
class Swimming {
public:
    Swimming(Bench& bench, const Scene& scene, const TurningScene& setup, const Motion& motion)
        : bench_(bench), scene_(scene), allMethods_(setup.allMethods),
          panel_(named({motion.name, setup.name})), size_(bench.reduced() ? 20 : 64),
          degrees_(turnedDegrees(bench.reduced())) {
        views_.push_back(motion.view(scene, 0.0));
        for (const double degrees : degrees_) {
            views_.push_back(motion.view(scene, degrees));
        }
        for (const View& view : views_) {
            references_.push_back(renderContinuous({.texels = &scene.texels(),
                                                    .geometry = scene.geometry(),
                                                    .tf = scene.look().tf,
                                                    .view = view,
                                                    .viewport = viewport(),
                                                    .tolerance = 1e-8}));
        }
    }

    void run(LatticeKind kind, bool jitter) {
        lattice_ = named({name(kind), jitter ? "jitter" : ""});
        Settings settings = settingsOf(methods().front());
        settings.lattice = kind;
        settings.jitter = jitter;
        const Result<FramePlan> plan = bench_.plan(scene_, settings);
        if (!plan) {
            return bench_.recordFailure({.family = "in-time", .name = caseName("")}, plan.error());
        }
        allow(*plan);
        recordSwimming("float64", sampled(plan->lattice));
        Drawing rayCasting;
        for (const Method* method : compared()) {
            settings.layersPerPlane = method->layersPerPlane;
            settings.target = method->target;
            const Result<Drawing> drawing = drawn(settings);
            if (!drawing) {
                bench_.recordFailure({.family = "in-time", .name = caseName(method->name)},
                                     drawing.error());
                continue;
            }
            recordSwimming(method->name, drawing->pictures, drawing->blending);
            if (rayCasting.pictures.empty()) {
                rayCasting = *drawing;
            } else {
                recordRatio(method->name, *drawing, rayCasting);
            }
        }
    }

private:
    struct Drawing {
        std::vector<Pixels> pictures;
        std::vector<std::vector<double>> blending; // what it may do to each pixel
    };

    Viewport viewport() const { return {0, 0, size_, size_}; }

    std::string caseName(std::string_view method, std::string_view rest = "") const {
        return named({panel_, lattice_, method, rest});
    }

    /// Ray casting first: what the others are compared to.
    std::vector<const Method*> compared() const {
        const std::span<const Method> all = methods();
        return allMethods_ ? std::vector{&all[5], &all[4], &all[3], &all[0]} : std::vector{&all[5]};
    }

    Allowance allowanceOf(const ReferencePicture& reference, const View& view,
                          const Lattice& lattice, glm::ivec2 pixel) const {
        using enum SamplingBound::By;
        const glm::dvec2 place = glm::dvec2(pixel) + 0.5;
        const EyeRay ray = eyeRayOf(view, viewport(), scene_.geometry(), place);
        const double jitter = lattice.jittered ? jitterOf(pixel) : 0.0;
        const PixelReference exact = reference.at(place);
        return {SamplingBound(scene_, Transfer).ofSampling(ray, lattice, jitter),
                SamplingBound(scene_, Table).ofSampling(ray, lattice, jitter), exact.bound,
                exact.atEdge};
    }

    /// In this view or before anything turned.
    bool grazes(std::size_t view, std::size_t pixel) const {
        return allowances_[0][pixel].atEdge || allowances_[view][pixel].atEdge;
    }

    void allow(const FramePlan& plan) {
        allowances_.clear();
        for (const View& view : views_) {
            const ReferencePicture reference(scene_, plan, view, viewport());
            std::vector<Allowance> allowed(references_.front().size());
            parallelFor(
                std::int64_t(allowed.size()), size_, [&](std::int64_t begin, std::int64_t end) {
                    for (std::int64_t i = begin; i < end; ++i) {
                        allowed[std::size_t(i)] =
                            allowanceOf(reference, view, plan.lattice, {i % size_, i / size_});
                    }
                });
            allowances_.push_back(std::move(allowed));
        }
    }

    std::vector<Pixels> sampled(const Lattice& lattice) const {
        std::vector<Pixels> pictures;
        for (const View& view : views_) {
            pictures.push_back(renderDiscrete(samplesOf(scene_, view, glm::ivec2(size_), lattice)));
        }
        return pictures;
    }

    Result<Drawing> drawn(const Settings& settings) {
        Drawing drawing;
        for (const View& view : views_) {
            const Result<Drawn> frame = bench_.draw(scene_, settings, view, glm::ivec2(size_));
            if (!frame) {
                return tl::unexpected(frame.error());
            }
            const std::vector<glm::vec4>& pixels = frame->picture.pixels;
            drawing.pictures.emplace_back(pixels.begin(), pixels.end());
            drawing.blending.push_back(
                blendingBounds({"", "", scene_, view, glm::ivec2(size_)}, frame->plan, 0.0));
        }
        return drawing;
    }

    /// How far a view's pixel may be from the integral; without `blending`: not drawn by a device.
    double errorBound(std::size_t view, std::size_t pixel,
                      const std::vector<std::vector<double>>& blending) const {
        const Allowance& allowed = allowances_[view][pixel];
        return blending.empty()
                   ? allowed.sampling
                   : allowed.deviceSampling + allowed.arithmetic + blending[view][pixel];
    }

    void recordSwimming(const std::string& method, const std::vector<Pixels>& pictures,
                        const std::vector<std::vector<double>>& blending = {}) {
        for (std::size_t k = 1; k < pictures.size(); ++k) {
            SquareSum changes;
            SquareSum bounds;
            SquareSum integralChanges;
            Picture shown{glm::ivec2(size_), {}};
            for (std::size_t i = 0; i < pictures[k].size(); ++i) {
                const glm::dvec4 integralChange = references_[k][i] - references_[0][i];
                const glm::dvec4 swum = (pictures[k][i] - pictures[0][i]) - integralChange;
                shown.pixels.emplace_back(glm::abs(glm::vec3(swum)) * 16.0F, 1.0F);
                if (!grazes(k, i)) {
                    changes.add(largest(swum));
                    integralChanges.add(largest(integralChange));
                    bounds.add(errorBound(0, i, blending) + errorBound(k, i, blending));
                }
            }
            const double degrees = degrees_[k - 1];
            Case result{.family = "in-time",
                        .name = caseName(method, number(degrees) + " degrees"),
                        .quantity = "RMS of the pixels' change less the integral's own (" +
                                    number(integralChanges.rms()) + "), of full scale",
                        .bound = bounds.rms(),
                        .reason = kSwimmingReason,
                        .measured = changes.rms(),
                        .series = Series{.group = named({lattice_, method}),
                                         .panel = panel_,
                                         .x = degrees,
                                         .y = changes.rms(),
                                         .xLabel = kTurnedLabel,
                                         .yLabel = "RMS change of the error"}};
            if (blending.empty() && k + 1 == pictures.size()) {
                result.pictures = {{"change of the error, 16 times", std::move(shown)}};
            }
            bench_.record(std::move(result));
        }
    }

    void recordRatio(const std::string& method, const Drawing& drawing, const Drawing& rayCasting) {
        SquareSum differences;
        SquareSum bounds;
        const auto change = [](const auto& of, std::size_t k, std::size_t i) {
            return of.pictures[k][i] - of.pictures[0][i];
        };
        const auto rounding = [](const auto& of, std::size_t k, std::size_t i) {
            return of.blending[k][i] + of.blending[0][i];
        };
        for (std::size_t k = 1; k < drawing.pictures.size(); ++k) {
            for (std::size_t i = 0; i < drawing.pictures[k].size(); ++i) {
                if (!grazes(k, i)) {
                    differences.add(largest(change(drawing, k, i) - change(rayCasting, k, i)));
                    bounds.add(rounding(drawing, k, i) + rounding(rayCasting, k, i) + 0x1p-16);
                }
            }
        }
        bench_.record({.family = "in-time",
                       .name = caseName(method, "against ray casting"),
                       .quantity = "RMS of the difference between their changes, of full scale",
                       .bound = bounds.rms(),
                       .reason = kRatioReason,
                       .measured = differences.rms()});
    }

    Bench& bench_;
    const Scene& scene_;
    bool allMethods_;
    std::string panel_;   // motion and scene
    std::string lattice_; // "shells, jitter"
    int size_;
    std::vector<double> degrees_;
    std::vector<View> views_;
    std::vector<Pixels> references_;
    std::vector<std::vector<Allowance>> allowances_; // of the lattice that is at work
};

} // namespace

void swimmingCases(Bench& bench, const Scene& scene, const TurningScene& setup,
                   const Motion& motion) {
    Swimming swimming(bench, scene, setup, motion);
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const bool jitter : {false, true}) {
            swimming.run(kind, jitter);
        }
    }
}

} // namespace slabcast::stability

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/volume/phantoms.h"
#include "perf/model/gpu_rates.h"
#include "perf/stability/head_rays.h"
#include "perf/stability/phone_cost.h"
#include "perf/stability/turning.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "lattices";
constexpr LatticeKind kKinds[] = {LatticeKind::Planar, LatticeKind::Shells};
constexpr const char* kPhones[] = {"g71", "g57", "adreno650", "adreno740"};
constexpr int kLayersPerPlane[] = {1, 2, 16};
/// Voxels from layer to layer at which costs are compared.
constexpr double kUsualSpacing = 1.0;

/// What `--lattice auto` puts up with for a picture that does not swim: shells may take a GPU so
/// many times as long as planar layers of the same spacing. Slices are dear in any case.
constexpr double kDearestSegment = 1.3;
constexpr double kDearestSlices = 2.0;

const char* const kSwimReason =
    "a head that turns leaves every ray of the world where it is, and its integral with it; the "
    "lattice moves the samples (planar: to the same view depths; shells: not at all, but for the "
    "2^-44 of the distance that rounding takes). No layer changes the pixel by more than the "
    "transmittance before it times the material's range along that way; and no two sums differ by "
    "more than both of their distances from the integral. The smaller of the two, RMS over rays";
const char* const kShellsStayReason =
    "shells' samples stay on their rays to rounding, 2^-44 of the distance; planar ones move by a "
    "share of a layer. A millionth is far from both, and what did not swim at all has no quotient";
const char* const kErrorReason =
    "each layer stands for its length by the material in its middle: that against its extremes in "
    "the layer, weighted by the transmittance before it. RMS over rays";
const char* const kCostReason =
    "no derivation: what --lattice auto puts up with, so that a head's turn leaves the picture "
    "still. Beyond it the choice is to be made anew (core/plan/decisions/lattice.cpp)";

struct LatticeScene {
    const char* name;
    const char* phantom;
    TransferFunction tf;
    bool fillsTheView; // visible to the volume's faces, so that these cut rays
};

/// Under steps and smooth where faces cut rays, and surfaces that no face touches.
std::vector<LatticeScene> latticeScenes() {
    std::vector<TurningScene> turning = turningScenes();
    const TransferFunction steps{.points = {{0.5, {0.9, 0.6, 0.3}, 0.0},
                                            {0.5, {0.9, 0.6, 0.3}, 0.05},
                                            {0.75, {0.9, 0.6, 0.3}, 0.05},
                                            {0.75, {0.3, 0.5, 1.0}, 0.12}}};
    return {{"smooth", turning[1].phantom, turning[1].tf, true},
            {"steps", turning[1].phantom, steps, true},
            {"surfaces inside", turning[0].phantom, turning[0].tf, false}};
}

/// Swim, error and cost of both lattices from one eye, over one scene, in one field of view.
class Comparison {
public:
    Comparison(Bench& bench, const Scene& scene, const LatticeScene& setup, double fovDegrees)
        : bench_(bench), scene_(scene), bound_(scene, SamplingBound::By::Transfer),
          panel_(named({setup.name, number(fovDegrees) + " degrees"})),
          rays_(scene, fovDegrees, bench.reduced() ? 10 : 20),
          truth_(rays_.integrals()), regions_{Region::All} {
        if (setup.fillsTheView) {
            regions_ = {Region::All, Region::Centre, Region::Border};
        }
    }

    void run(double spacing) {
        spacing_ = number(spacing) + " voxels a layer";
        std::vector<std::vector<double>> swims;
        for (const LatticeKind kind : kKinds) {
            const Result<Lattice> lattice = latticeOf(kind, spacing);
            if (!lattice) {
                return bench_.recordFailure({.family = kFamily, .name = caseName(name(kind))},
                                            lattice.error());
            }
            const Gathered straight = rays_.gathered(*lattice, 0.0);
            recordErrors(*lattice, straight);
            swims.push_back(recordSwims(*lattice, straight));
        }
        for (std::size_t k = 0; k < turns().size(); ++k) {
            bench_.record({.family = kFamily,
                           .name = caseName("swim, shells over planar", turned(turns()[k])),
                           .quantity = "RMS change over RMS change",
                           .bound = 1e-6,
                           .reason = kShellsStayReason,
                           .measured = swims[1][k] / swims[0][k]});
        }
        if (spacing == kUsualSpacing) {
            for (const int layersPerPlane : kLayersPerPlane) {
                compareCosts(layersPerPlane);
            }
        }
    }

private:
    std::vector<double> turns() const {
        return bench_.reduced() ? std::vector{1.0} : std::vector{1.0, 5.0};
    }
    static std::string turned(double degrees) {
        return "turned by " + number(degrees) + " degrees";
    }

    std::string caseName(std::string_view what, std::string_view rest = "",
                         std::string_view more = "") const {
        return named({kFamily, panel_, spacing_, what, rest, more});
    }

    /// Segments written out, as a phone gets them.
    static Settings settingsFor(LatticeKind kind, double spacing, int layersPerPlane) {
        Settings settings;
        settings.lattice = kind;
        settings.layerSpacingVoxels = spacing;
        settings.layersPerPlane = layersPerPlane;
        settings.form = SegmentForm::Unrolled;
        return settings;
    }

    Result<Lattice> latticeOf(LatticeKind kind, double spacing) const {
        return bench_.plan(scene_, settingsFor(kind, spacing, 1)).map([](const FramePlan& plan) {
            return plan.lattice;
        });
    }

    std::vector<double> ofAllRays(const std::function<double(std::size_t)>& ofRay) const {
        std::vector<double> all(truth_.size());
        parallelFor(rays_.count(), 16, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                all[std::size_t(i)] = ofRay(std::size_t(i));
            }
        });
        return all;
    }

    double rmsOver(Region region, const std::vector<double>& ofRays) const {
        SquareSum sum;
        for (int i = 0; i < rays_.count(); ++i) {
            if (rays_.isIn(region, i)) {
                sum.add(ofRays[std::size_t(i)]);
            }
        }
        return sum.rms();
    }

    static double differenceOf(const glm::dvec4& a, const glm::dvec4& b) { return largest(a - b); }

    /// Of each ray: how far it is from the integral, and may be.
    struct Errors {
        std::vector<double> found, allowed;
    };
    Errors errorsOf(const Lattice& lattice, const Gathered& straight) const {
        return {
            ofAllRays([&](auto i) { return differenceOf(straight.pixels[i], truth_[i]); }),
            ofAllRays([&](auto i) { return bound_.ofSampling(straight.rays[i], lattice, 0.0); })};
    }

    void recordErrors(const Lattice& lattice, const Gathered& straight) {
        const Errors errors = errorsOf(lattice, straight);
        for (const Region region : regions_) {
            const double error = rmsOver(region, errors.found);
            bench_.record({.family = kFamily,
                           .name = caseName("error", name(lattice.kind), name(region)),
                           .quantity = "RMS difference from the integral, of full scale",
                           .bound = rmsOver(region, errors.allowed),
                           .reason = kErrorReason,
                           .measured = error,
                           .series = Series{.group = named({name(lattice.kind), name(region)}),
                                            .panel = panel_,
                                            .x = lattice.spacingMm,
                                            .y = error,
                                            .xLabel = "layer spacing, mm",
                                            .yLabel = "RMS error"}});
        }
    }

    /// Returns the whole view's, turn by turn.
    std::vector<double> recordSwims(const Lattice& lattice, const Gathered& straight) {
        std::vector<double> whole;
        for (const double degrees : turns()) {
            const Gathered after = rays_.gathered(lattice, degrees);
            const std::vector<double> swum = ofAllRays(
                [&](auto i) { return differenceOf(after.pixels[i], straight.pixels[i]); });
            const std::vector<double> allowed = ofAllRays([&](auto i) {
                const EyeRay& from = straight.rays[i];
                const EyeRay& to = after.rays[i];
                return std::min(bound_.ofSampling(from, lattice, 0.0) +
                                    bound_.ofSampling(to, lattice, 0.0),
                                bound_.ofMotion(from, to, lattice));
            });
            for (const Region region : regions_) {
                bench_.record({.family = kFamily,
                               .name = caseName("swim", name(lattice.kind),
                                                named({turned(degrees), name(region)})),
                               .quantity = "RMS change of a world ray's pixel, of full scale",
                               .bound = rmsOver(region, allowed),
                               .reason = kSwimReason,
                               .measured = rmsOver(region, swum)});
            }
            whole.push_back(rmsOver(Region::All, swum));
        }
        return whole;
    }

    using Work = std::array<FrameWork, std::size(kKinds)>;
    Result<Work> workOf(int layersPerPlane) {
        Work all;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const Settings settings = settingsFor(kKinds[k], kUsualSpacing, layersPerPlane);
            const Result<FrameWork> one =
                workOfMillion(bench_, scene_, settings, rays_.view(), rays_.share());
            if (!one) {
                return tl::unexpected(one.error());
            }
            all[k] = *one;
        }
        return all;
    }

    void compareCosts(int layersPerPlane) {
        const std::string layers = number(layersPerPlane) + " a plane";
        const Result<Work> work = workOf(layersPerPlane);
        if (!work) {
            return bench_.recordFailure({.family = kFamily, .name = caseName("cost", layers)},
                                        work.error());
        }
        for (const char* phone : kPhones) {
            const std::string where = named({phone, layers});
            if (Result<void> done = compareOn(*findGpuRates(phone), *work, layersPerPlane, where);
                !done) {
                bench_.recordFailure({.family = kFamily, .name = caseName("cost", where)},
                                     done.error());
            }
        }
    }

    /// At equal spacing; and planar layers as near to each other as shells' cost pays for.
    Result<void> compareOn(const GpuRates& gpu, const Work& work, int layersPerPlane,
                           const std::string& where) {
        ModelTerms terms[std::size(kKinds)];
        for (std::size_t k = 0; k < work.size(); ++k) {
            const Settings settings = settingsFor(kKinds[k], kUsualSpacing, layersPerPlane);
            const Result<std::optional<ModelTerms>> one =
                modelledOn(gpu, bench_, scene_, settings, work[k]);
            if (!one) {
                return tl::unexpected(one.error());
            }
            if (!*one) {
                return fail(ErrorCode::Internal, "perf/model's costs lack this GPU's shader");
            }
            terms[k] = **one;
        }
        const auto& [planar, shells] = terms;
        const auto said = [](const ModelTerms& of) {
            return number(of.frameMs) + " ms, " + of.limit;
        };
        bench_.record({.family = kFamily,
                       .name = caseName("cost, shells over planar", where),
                       .quantity = "time over time at equal spacing, a model's, of a million "
                                   "pixels (shells " +
                                   said(shells) + "; planar " + said(planar) + ")",
                       .bound = layersPerPlane < 8 ? kDearestSlices : kDearestSegment,
                       .reason = kCostReason,
                       .measured = shells.frameMs / planar.frameMs});
        // Cost goes with the number of layers, but for a ray's ends.
        const double spacing = kUsualSpacing * planar.frameMs / shells.frameMs;
        const Result<Lattice> lattice = latticeOf(LatticeKind::Planar, spacing);
        if (!lattice) {
            return tl::unexpected(lattice.error());
        }
        const Errors errors = errorsOf(*lattice, rays_.gathered(*lattice, 0.0));
        bench_.record({.family = kFamily,
                       .name = caseName("error at shells' cost, planar", where),
                       .quantity = "RMS difference from the integral, layers every " +
                                   number(spacing) + " voxels, of full scale",
                       .bound = rmsOver(Region::All, errors.allowed),
                       .reason = kErrorReason,
                       .measured = rmsOver(Region::All, errors.found)});
        return {};
    }

    Bench& bench_;
    const Scene& scene_;
    SamplingBound bound_;
    std::string panel_;   // scene and field of view
    std::string spacing_; // that is at work
    HeadRays rays_;
    std::vector<glm::dvec4> truth_;
    std::vector<Region> regions_;
};

} // namespace

void latticeCases(Bench& bench) {
    const bool reduced = bench.reduced();
    for (const LatticeScene& setup : latticeScenes()) {
        const Result<Volume> volume = makePhantom(setup.phantom);
        SLABCAST_EXPECTS(volume.has_value(), 48);
        const Result<Scene> scene =
            bench.scene(*volume, {.tf = setup.tf}, {.structure = SkipStructure::Proximity});
        if (!scene) {
            bench.recordFailure({.family = kFamily, .name = named({kFamily, setup.name})},
                                scene.error());
            continue;
        }
        for (const double fov : reduced ? std::vector{100.0} : std::vector{60.0, 80.0, 100.0}) {
            Comparison comparison(bench, *scene, setup, fov);
            for (const double spacing :
                 reduced ? std::vector{kUsualSpacing} : std::vector{0.5, kUsualSpacing, 2.0}) {
                comparison.run(spacing);
            }
        }
    }
}

} // namespace slabcast::stability

#include <algorithm>
#include <cmath>

#include "perf/stability/conditions.h"
#include "perf/stability/stiff.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

const char* const kUniformReason =
    "alpha = 1 - exp(-extinction x length in the box); extinction is off by 2^-11 of itself "
    "(the table's fp16), length by 2^-18 of itself (float32's ray), alpha by "
    "2^-23 per layer and 2^-18 of itself (float32's sums and exp), and a target's rounding at a "
    "plane (fp16: 2^-11, but 2^-10 of alpha at most, or the smallest step, 2^-24; 8 bits: 1/510 "
    "for colour, opacity and, but for the deepest plane, their product each) shows through what "
    "lies in front of it";

/// What a pixel of one material is, and how far it may be from that.
struct UniformPixel {
    double alpha = 0.0;
    double bound = 0.0;
};

/// Every plane's rounding is seen through the planes before it: a geometric sum.
double blendingOf(const FramePlan& plan, double depthPerLayer, double layers, double alpha) {
    // A half's step goes with alpha.
    const double share =
        plan.target == TargetFormat::Rgba8 ? 1.0 : std::max(std::min(1.0, 2.0 * alpha), 0x1p-13);
    const double planeOpacity = -std::expm1(-depthPerLayer * plan.layersPerPlane);
    const double planesMet =
        std::min<double>(plan.planes, std::ceil(layers / plan.layersPerPlane) + 1.0);
    const double seen = std::min(planesMet - 1.0, 1.0 / planeOpacity + 1.0);
    return share * (roundingOfDeepest(plan.target) + seen * roundingPerPlane(plan.target));
}

/// Of a ray that enters and leaves the box by the faces at its ends.
UniformPixel uniformPixel(const FramePlan& plan, const LatticeRay& ray, double extinction) {
    const double layers = ray.exit - ray.entry;
    const double lengthMm = layers * ray.layerLengthMm;
    const double depth = extinction * lengthMm;
    const double depthError = depth * (0x1p-11 + 0x1p-18);
    const double alpha = -std::expm1(-depth);
    const double most = std::exp(-depth) * -std::expm1(-depthError);
    const double least = std::exp(-std::max(0.0, depth - depthError)) - std::exp(-depth);
    return {alpha, std::max(most, least) + alpha * (plan.lattice.total * 0x1p-23 + 0x1p-18) +
                       blendingOf(plan, extinction * ray.layerLengthMm, layers, alpha)};
}

/// A scene of one material per ray, and which one a ray meets; nothing where it is not judged.
struct Medium {
    const char* name;
    const Scene& scene;
    View view;
    glm::ivec2 size;
    std::function<std::optional<double>(const LatticeRay& ray)> extinctionOf;
};

struct Judgement {
    double share = 0.0; // worst share of a pixel's bound
    double bound = 0.0; // of the pixel whose bound is the largest part of its alpha
    double alpha = 0.0; // of that pixel
};

Judgement judge(const Medium& medium, const FramePlan& plan, const Picture& picture) {
    const RayFrame frame = makeRayFrame(medium.view, {0, 0, medium.size.x, medium.size.y},
                                        medium.scene.geometry(), plan.lattice);
    Judgement result{.alpha = 1.0};
    for (int y = 0; y < medium.size.y; ++y) {
        for (int x = 0; x < medium.size.x; ++x) {
            const LatticeRay ray = rayAt(frame, glm::dvec2(x, y) + 0.5);
            const std::optional<double> extinction = medium.extinctionOf(ray);
            if (!extinction) {
                continue;
            }
            const UniformPixel meant = uniformPixel(plan, ray, *extinction);
            const std::size_t i = static_cast<std::size_t>(y) * medium.size.x + x;
            const double share =
                std::abs(static_cast<double>(picture.pixels[i].a) - meant.alpha) / meant.bound;
            result.share = share <= result.share ? result.share : share; // NaN stays
            if (meant.bound * result.alpha >= result.bound * meant.alpha) {
                result.bound = meant.bound;
                result.alpha = meant.alpha;
            }
        }
    }
    return result;
}

/// That the closed form holds; or, where no target of its kind could hold it, that the plan says
/// so, and that 8 bits lose what is below half of their step.
void recordMedium(Bench& bench, const Medium& medium, const Settings& settings,
                  const std::string& name) {
    Case c{.family = "stiff", .name = name, .reason = kUniformReason};
    const Result<Drawn> drawn = bench.draw(medium.scene, settings, medium.view, medium.size);
    if (!drawn) {
        bench.recordFailure(std::move(c), drawn.error());
        return;
    }
    const Judgement judged = judge(medium, drawn->plan, drawn->picture);
    if (judged.bound < judged.alpha / 2.0) {
        c.quantity = "worst share of a pixel's own bound, alpha";
        c.bound = 1.0;
        c.measured = judged.share;
        if (settings.target == TargetFormat::Rgba8 && settings.layersPerPlane == 16) {
            c.pictures.push_back({"medium", drawn->picture});
        }
        bench.record(std::move(c));
        return;
    }
    recordLoss(bench, c, medium.scene, *drawn,
               "rounding may take half of alpha or more, " + number(judged.bound) + " of " +
                   number(judged.alpha) + ": the plan has to say so");
}

// --- Opacities by numbers of layers ---

struct LayerOpacity {
    const char* name;
    double value;
};
constexpr LayerOpacity kOpacities[] = {{"opacity 1", 1.0},
                                       {"opacity 1-1e-7", 1.0 - 1e-7},
                                       {"opacity 1e-4", 1e-4},
                                       {"opacity 1e-6", 1e-6}};

void recordOpacity(Bench& bench, const LayerOpacity& opacity, int layers) {
    constexpr glm::ivec2 kSize(16, 16);
    const Volume volume =
        formulaVolume({8, 64, 8}, VoxelType::U8, [](glm::ivec3) { return 100.0; });
    const double layerMm = 2.0 * volume.geometry.boundingSphere().radiusMm / layers;
    const TransferFunction tf = uniformTransfer(opacity.value, glm::dvec3(1.0), layerMm);
    const Result<Scene> scene = bench.scene(volume, {.tf = tf}, {.structure = SkipStructure::None});
    const std::string lattice = std::to_string(layers) + " layers";
    if (!scene) {
        return bench.recordFailure({.family = "stiff", .name = named({opacity.name, lattice})},
                                   scene.error());
    }
    const double extinction = extinctionPerMm(scene->look().tf.points[0].opacity, layerMm);
    const Medium medium{opacity.name, *scene, distantView(*scene, 0.0, 3.0, kSize), kSize,
                        [=](const LatticeRay&) { return std::optional(extinction); }};
    for (const Method& method : methods()) {
        Settings settings = settingsOf(method);
        settings.totalLayers = layers;
        recordMedium(bench, medium, settings,
                     named({std::string(opacity.name) + " per layer", lattice, method.name}));
    }
}

// --- Units of length ---

struct Unit {
    const char* name;
    double opacityUnitMm;
    double opacity;
    double voxelMm;
};
constexpr Unit kUnits[] = {{"opacity of 1 nm, voxels of 1 mm", 1e-6, 1e-7, 1.0},
                           {"opacity of 1 km, voxels of 1 mm", 1e6, 1.0 - 1e-7, 1.0},
                           {"opacity of 1 nm, voxels of 1 nm", 1e-6, 0.1, 1e-6},
                           {"opacity of 1 km, voxels of 1 km", 1e6, 0.1, 1e6}};

void recordUnit(Bench& bench, const Unit& unit, const Spacing& spacing) {
    constexpr glm::ivec2 kSize(24, 24);
    const Volume volume = formulaVolume(
        {16, 16, 16}, VoxelType::U8, [](glm::ivec3) { return 100.0; }, glm::dvec3(unit.voxelMm));
    const TransferFunction tf = uniformTransfer(unit.opacity, glm::dvec3(1.0), unit.opacityUnitMm);
    const Result<Scene> scene = bench.scene(volume, {.tf = tf}, {.structure = SkipStructure::None});
    if (!scene) {
        return bench.recordFailure({.family = "stiff", .name = named({unit.name, spacing.name})},
                                   scene.error());
    }
    const double extinction =
        extinctionPerMm(scene->look().tf.points[0].opacity, unit.opacityUnitMm);
    const View view = distantView(*scene, 0.0, 6.0 * unit.voxelMm, kSize);
    const Medium medium{unit.name, *scene, view, kSize,
                        [=](const LatticeRay&) { return std::optional(extinction); }};
    for (const Method& method : methods()) {
        recordMedium(bench, medium, settingsOf(method, spacing),
                     named({unit.name, spacing.name, method.name}));
    }
}

// --- Twelve decades in one TF ---

constexpr int kDecades = 12;
constexpr int kVoxelsPerDecade = 3;
constexpr double kValuesPerDecade = 16.0;

/// Steps from 1e-12 to 1, a decade each.
TransferFunction decadesTransfer(double opacityUnitMm) {
    TransferFunction tf{.name = "decades", .opacityUnitMm = opacityUnitMm};
    const auto opacityOf = [](int decade) { return std::pow(10.0, decade - kDecades); };
    for (int decade = 1; decade <= kDecades; ++decade) {
        const double value = kValuesPerDecade * (decade - 0.5);
        tf.points.push_back({value, glm::dvec3(1.0), opacityOf(decade - 1)});
        tf.points.push_back({value, glm::dvec3(1.0), opacityOf(decade)});
    }
    return tf;
}

struct Decades {
    const char* name;
    double opacityUnitMm;
};
// Of 1 mm, the dense ones show; of 1e-9 mm, the faint ones.
constexpr Decades kDecadeUnits[] = {{"12 decades of extinction, the dense end", 1.0},
                                    {"12 decades of extinction, the faint end", 1e-9}};

void recordDecades(Bench& bench, const Decades& decades, const Spacing& spacing) {
    constexpr glm::ivec3 kDims((kDecades + 1) * kVoxelsPerDecade, 12, 6);
    constexpr glm::ivec2 kSize(kDims.x * 4, kDims.z * 4);
    const Volume volume = formulaVolume(kDims, VoxelType::U8, [](glm::ivec3 v) {
        return kValuesPerDecade * (v.x / kVoxelsPerDecade);
    });
    const Result<Scene> scene = bench.scene(volume, {.tf = decadesTransfer(decades.opacityUnitMm)},
                                            {.structure = SkipStructure::None});
    if (!scene) {
        return bench.recordFailure({.family = "stiff", .name = named({decades.name, spacing.name})},
                                   scene.error());
    }
    // Between the centres of a decade's outer voxels the field is constant; rays lean by an eighth
    // of a voxel on their way.
    const auto extinctionOf = [&](const LatticeRay& ray) -> std::optional<double> {
        const double x = ray.centre.x * kDims.x / kVoxelsPerDecade;
        const double decade = std::floor(x);
        if (std::abs(x - decade - 0.5) * kVoxelsPerDecade > 0.8) {
            return std::nullopt;
        }
        const TransferSample sample = evaluate(scene->look().tf, decade * kValuesPerDecade);
        return extinctionPerMm(sample.opacity, decades.opacityUnitMm);
    };
    const View view = distantView(*scene, 0.0, kDims.z / 2.0, kSize);
    const Medium medium{decades.name, *scene, view, kSize, extinctionOf};
    for (const Method& method : methods()) {
        Case c{.family = "stiff",
               .name = named({decades.name, spacing.name, method.name}),
               .quantity = "worst share of a pixel's own bound, alpha",
               .bound = 1.0,
               .reason = kUniformReason};
        bench.examine(std::move(c), *scene, settingsOf(method, spacing), view, kSize,
                      [&](Case& judged, const Drawn& drawn) {
                          judged.measured = judge(medium, drawn.plan, drawn.picture).share;
                          if (isShown(method)) {
                              judged.pictures.push_back({"a decade per strip", drawn.picture});
                          }
                      });
    }
}

} // namespace

void stiffMediumCases(Bench& bench) {
    for (const LayerOpacity& opacity : kOpacities) {
        recordOpacity(bench, opacity, 500);
        if (!bench.reduced()) {
            recordOpacity(bench, opacity, 8000);
        }
    }
    for (const Spacing& spacing : std::span(kSpacings).first(bench.reduced() ? 1 : 2)) {
        for (const Unit& unit : kUnits) {
            recordUnit(bench, unit, spacing);
        }
        for (const Decades& decades : kDecadeUnits) {
            recordDecades(bench, decades, spacing);
        }
    }
}

} // namespace slabcast::stability

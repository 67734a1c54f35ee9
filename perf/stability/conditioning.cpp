#include <algorithm>
#include <cmath>

#include "perf/stability/change_bound.h"
#include "perf/stability/perturbed_inputs.h"
#include "perf/stability/symmetry.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "conditioning";
constexpr double kUlp = 0x1p-23; // of float32, of the number itself, at most

glm::ivec2 sizeOf(const Bench& bench) {
    return glm::ivec2(bench.reduced() ? 10 : 20);
}

// --- Scenes ---

struct Subject {
    const char* name;
    double (*value)(glm::ivec3 v);
    TransferFunction tf;
};

/// 128 within, 40 without: all of the inside lies on a step at 128.
double plateau(glm::ivec3 v) {
    const glm::dvec3 away = (glm::dvec3(v) - glm::dvec3(6.5, 4.5, 8.5)) / glm::dvec3(5.0, 3.5, 6.5);
    return glm::length(away) < 1.0 ? 128.0 : 40.0;
}

std::vector<Subject> subjects() {
    const auto ramps = [](double low, double middle, double high) {
        return TransferFunction{.points = {{30.0, {0.1, 0.4, 0.9}, low},
                                           {120.0, {0.8, 0.5, 0.3}, middle},
                                           {230.0, {0.9, 0.7, 0.2}, high}}};
    };
    return {{"ramps", lopsided, ramps(0.02, 0.12, 0.3)},
            {"dense ramps", lopsided, ramps(0.2, 0.9, 0.999)},
            {"step on the data's value",
             plateau,
             {.points = {{30.0, {0.1, 0.4, 0.9}, 0.02},
                         {128.0, {0.1, 0.4, 0.9}, 0.04},
                         {128.0, {0.9, 0.6, 0.3}, 0.3},
                         {230.0, {0.9, 0.7, 0.2}, 0.3}}}}};
}

Volume volumeOf(const Subject& subject, const VolumeGeometry& geometry) {
    Volume volume = formulaVolume({14, 10, 18}, VoxelType::U8, subject.value, geometry.spacingMm);
    return placedAt(std::move(volume), geometry.originMm, geometry.direction);
}

Result<Scene> sceneOf(Bench& bench, const Subject& subject, const VolumeGeometry& geometry,
                      const TransferFunction& tf) {
    return bench.scene(volumeOf(subject, geometry), {.tf = tf}, {.structure = SkipStructure::None},
                       true);
}

VolumeGeometry geometryOf() {
    return {.dims = {14, 10, 18},
            .spacingMm = {0.8, 1.3, 0.6},
            .originMm = {12.0, -8.0, 4.0},
            .direction = obliqueAxes()};
}

SampleSetup setupOf(const Scene& scene, glm::ivec2 size) {
    const BoundingSphere sphere = scene.geometry().boundingSphere();
    const double spacingMm = scene.geometry().smallestVoxelEdgeMm();
    return {.texels = &scene.texels(),
            .geometry = scene.geometry(),
            .tf = scene.look().tf,
            .view = orbitView(scene, {37.0, 23.0, 2.4}, 40.0, size),
            .lattice = {LatticeKind::Planar, layersToCover(sphere.radiusMm, spacingMm), spacingMm}};
}

double largestOf(glm::dvec4 v) {
    const glm::dvec4 size = glm::abs(v);
    return std::max({size.x, size.y, size.z, size.w});
}

// --- In float64 ---

struct Changes {
    double largest = 0.0;
    double smooth = 0.0; // the largest of pixels without a sample that may pass a step
    double bound = 0.0;  // of those
    int covered = 0;
    int jumps = 0; // pixels that change by more than derivatives say
    int unexplained = 0;
};

Changes changesOf(const std::vector<glm::dvec4>& before, const std::vector<glm::dvec4>& after,
                  const ChangeBound& bound, glm::ivec2 size, double rounding) {
    Changes found;
    for (int i = 0; i < size.x * size.y; ++i) {
        const PixelChange allowed = bound.at(glm::dvec2(i % size.x, i / size.x) + 0.5);
        const double change = largestOf(after[std::size_t(i)] - before[std::size_t(i)]);
        const bool jumps = !(change <= allowed.bound + rounding); // as NaN does
        found.largest = largerOf(found.largest, change);
        found.covered += allowed.covered;
        found.jumps += jumps;
        found.unexplained += jumps && !allowed.meetsStep;
        if (!allowed.meetsStep) {
            found.smooth = largerOf(found.smooth, change);
            found.bound = std::max(found.bound, allowed.bound + rounding);
        }
    }
    return found;
}

bool hasStep(const TransferFunction& tf) {
    return std::adjacent_find(tf.points.begin(), tf.points.end(),
                              [](const TransferPoint& a, const TransferPoint& b) {
                                  return a.value == b.value;
                              }) != tf.points.end();
}

/// Layers' sums in float64, and their places, before and after.
double roundingOf(const SampleSetup& setup) {
    return 64.0 * setup.lattice.total * 0x1p-53;
}

const char* const kConditionReason =
    "no layer moves a pixel by more than T (a + alpha c), T being what the layers before it let "
    "through, a and c what its opacity and its colour change by: a sample's way in the box times "
    "the field's steepest slopes there, times the steepest ramp it may lie on, and the transfer "
    "function's own derivative by its logarithm; over the input's relative change; and float64's "
    "rounding";
const char* const kStepReason =
    "a step has no derivative: past it a sample jumps, however small the change. Only where no "
    "sample may pass one do derivatives bound the pixel; beyond that bound no other may change";

void recordInput(Bench& bench, const char* subject, const Input& input, const SampleSetup& before,
                 const std::vector<glm::dvec4>& pixels, double share) {
    const glm::ivec2 size = sizeOf(bench);
    SampleSetup after = before;
    input.grow(after, share);
    const ChangeBound bound(before, after, size, share, input.slopes);
    const Changes found =
        changesOf(pixels, samplesOf(after, size), bound, size, roundingOf(before));
    const std::string times = share == kUlp ? "1 ulp" : number(share / kUlp, 6) + " ulps";
    const std::string name = named({subject, input.name, times});
    const double limit = found.bound / share;
    const bool bounded = !(input.passesSteps && hasStep(before.tf));
    bench.record(
        {.family = kFamily,
         .name = name,
         .quantity = "condition number: largest change over the input's, where no step is "
                     "met",
         .bound = limit,
         .reason = kConditionReason,
         .measured = found.smooth / share,
         .series = Series{.group = input.name,
                          .panel = subject,
                          .x = share,
                          .y = found.largest / share,
                          .xLabel = "relative change of the input",
                          .yLabel = "largest change of the picture over it",
                          .bound = bounded ? std::optional(limit) : std::nullopt},
         .condition = Condition{.scene = subject,
                                .input = named({input.name, times}),
                                .perturbation = share,
                                .largestChange = found.largest,
                                .limit = bounded ? std::optional(limit) : std::nullopt,
                                .jumpingShare = double(found.jumps) / std::max(1, found.covered)}});
    if (!bounded) {
        bench.record({.family = kFamily,
                      .name = named({name, "unexplained"}),
                      .quantity = "pixels beyond their bound, of which no sample may pass a step",
                      .reason = kStepReason,
                      .measured = double(found.unexplained)});
    }
}

// --- Drawn ---

struct DrawnSetup {
    Picture picture;
    ExpectedPicture expected;
    Lattice lattice;
};

Result<DrawnSetup> drawnOf(Bench& bench, const Subject& subject, const SampleSetup& setup) {
    const glm::ivec2 size = sizeOf(bench);
    const Result<Scene> scene = sceneOf(bench, subject, setup.geometry, setup.tf);
    if (!scene) {
        return tl::unexpected(scene.error());
    }
    Settings settings = settingsOf(methods().back());
    settings.layerSpacingVoxels = setup.lattice.spacingMm / scene->geometry().smallestVoxelEdgeMm();
    const Result<FramePlan> plan = bench.plan(*scene, settings);
    const Result<Picture> picture =
        plan ? bench.drawFinely(*scene, *plan, setup.view, size) : tl::unexpected(plan.error());
    if (!picture) {
        return tl::unexpected(picture.error());
    }
    const Exhibit exhibit{
        .family = "", .name = "", .scene = *scene, .view = setup.view, .size = size};
    return DrawnSetup{*picture, expectedFromSamples(exhibit, *plan), plan->lattice};
}

const char* const kDrawnReason =
    "as in float64, and what each of both pictures may differ by from float64 over its samples: "
    "that is more than one ulp of any input does, unless the table's fp16 turns it into a step of "
    "its own, 2^-10 of extinction and of colour";

void recordDrawn(Bench& bench, const Subject& subject, const Input& input,
                 const SampleSetup& before, const Result<DrawnSetup>& original) {
    const glm::ivec2 size = sizeOf(bench);
    Case c{.family = kFamily,
           .name = named(
               {subject.name, input.name, "1 ulp", std::string("drawn in ") + bench.finest().name}),
           .quantity = "largest change, of full scale",
           .reason = kDrawnReason};
    SampleSetup after = before;
    input.grow(after, kUlp);
    const Result<DrawnSetup> changed = drawnOf(bench, subject, after);
    if (!original || !changed) {
        return bench.recordFailure(std::move(c), original ? changed.error() : original.error());
    }
    const ChangeBound bound(before, after, size, kUlp, input.slopes);
    const double table = input.slopes == nullptr ? 0.0 : 2.0 * 0x1p-10;
    const double target = 2.0 * bench.finest().rounding;
    for (std::size_t i = 0; i < original->expected.size(); ++i) {
        const glm::dvec2 at(double(i % std::size_t(size.x)), double(i / std::size_t(size.x)));
        if (!original->expected[i].atEdge && !changed->expected[i].atEdge) {
            c.bound = std::max(c.bound, bound.at(at + 0.5).bound + original->expected[i].bound +
                                            changed->expected[i].bound + table + target);
        }
    }
    const std::vector<glm::dvec4> meant(original->picture.pixels.begin(),
                                        original->picture.pixels.end());
    c.measured = largestDifference(changed->picture, meant);
    if (original->lattice.total != changed->lattice.total) {
        c.failure = "another number of layers";
    }
    c.condition =
        Condition{.scene = named({subject.name, std::string("drawn in ") + bench.finest().name}),
                  .input = named({input.name, "1 ulp"}),
                  .perturbation = kUlp,
                  .largestChange = c.measured,
                  .limit = c.bound / kUlp};
    bench.record(std::move(c));
}

const char* const kDrawnStepReason =
    "no derivative bounds what jumps; but a drawn picture has to jump where float64 over its "
    "samples does, by the same table: either picture is within its own bound of that";

/// Of a step: that the drawn pictures change as float64's do, and how many pixels jump.
void recordDrawnStep(Bench& bench, const Subject& subject, const Input& input,
                     const SampleSetup& before, const Result<DrawnSetup>& original) {
    const glm::ivec2 size = sizeOf(bench);
    const std::string drawnIn = std::string("drawn in ") + bench.finest().name;
    Case c{.family = kFamily,
           .name = named({subject.name, input.name, "1 ulp", drawnIn}),
           .quantity = "worst share of both pictures' own bounds, change against float64's",
           .bound = 1.0,
           .reason = kDrawnStepReason};
    SampleSetup after = before;
    input.grow(after, kUlp);
    const Result<DrawnSetup> changed = drawnOf(bench, subject, after);
    if (!original || !changed) {
        return bench.recordFailure(std::move(c), original ? changed.error() : original.error());
    }
    const ChangeBound bound(before, after, size, kUlp, input.slopes);
    Condition found{.scene = named({subject.name, drawnIn}),
                    .input = named({input.name, "1 ulp"}),
                    .perturbation = kUlp};
    int covered = 0;
    int jumps = 0;
    for (std::size_t i = 0; i < original->expected.size(); ++i) {
        const PixelReference& a = original->expected[i];
        const PixelReference& b = changed->expected[i];
        if (a.atEdge || b.atEdge) {
            continue;
        }
        const glm::dvec4 change =
            glm::dvec4(changed->picture.pixels[i]) - glm::dvec4(original->picture.pixels[i]);
        const double allowed = a.bound + b.bound + 2.0 * bench.finest().rounding;
        c.measured = largerOf(c.measured, largestOf(change - (b.color - a.color)) / allowed);
        const glm::dvec2 at(double(i % std::size_t(size.x)), double(i / std::size_t(size.x)));
        const PixelChange smooth = bound.at(at + 0.5);
        const double table = input.slopes == nullptr ? 0.0 : 2.0 * 0x1p-10;
        covered += smooth.covered;
        jumps += largestOf(change) > smooth.bound + allowed + table;
        found.largestChange = largerOf(found.largestChange, largestOf(change));
    }
    found.jumpingShare = double(jumps) / std::max(1, covered);
    c.condition = found;
    bench.record(std::move(c));
}

} // namespace

void conditioningCases(Bench& bench) {
    const glm::ivec2 size = sizeOf(bench);
    for (const Subject& subject : subjects()) {
        const Result<Scene> scene = sceneOf(bench, subject, geometryOf(), subject.tf);
        if (!scene) {
            bench.recordFailure({.family = kFamily, .name = subject.name}, scene.error());
            continue;
        }
        const SampleSetup setup = setupOf(*scene, size);
        const std::vector<glm::dvec4> pixels = samplesOf(setup, size);
        for (const Input& input : perturbedInputs()) {
            for (const double ulps : {1.0, 64.0, 4096.0}) {
                recordInput(bench, subject.name, input, setup, pixels, ulps * kUlp);
            }
        }
        const Result<DrawnSetup> original = drawnOf(bench, subject, setup);
        for (const Input& input : perturbedInputs()) {
            const bool jumps = input.passesSteps && hasStep(setup.tf);
            (jumps ? recordDrawnStep : recordDrawn)(bench, subject, input, setup, original);
        }
    }
}

} // namespace slabcast::stability

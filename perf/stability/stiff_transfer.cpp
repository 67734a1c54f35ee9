#include <algorithm>
#include <cmath>

#include "perf/stability/conditions.h"
#include "perf/stability/stiff.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr int kDepth = 48; // voxels along the rays
constexpr double kUnitsPerVoxel = 64.0;
constexpr glm::ivec2 kSize(48, 32);
constexpr double kAzimuth = 10.0; // so that pixels meet a value at every phase of the layers
/// What a layer's depth is of the way through the ramp; rays lean a little, too.
const double kCosine = std::cos(glm::radians(kAzimuth + 0.5));
constexpr Classification kClassifications[] = {Classification::Post, Classification::Preintegrated};

/// What the sampled value may be off by, as the texel self-test allows it: 1/256 of what lies
/// between two texels, and a step of the format.
constexpr double kValueError = kUnitsPerVoxel / 256.0 + 1.0;

/// Values that rise, or fall, by 64 units per voxel away from the eye: in integers, so that the
/// table has a texel for each, and linear, so that the trilinear field is too.
Volume rampVolume(bool rises) {
    return formulaVolume({12, kDepth, 12}, VoxelType::U16, [=](glm::ivec3 v) {
        return kUnitsPerVoxel * (rises ? v.y : kDepth - 1 - v.y);
    });
}

// --- A step from nothing to opaque ---

/// Behind the surface the colour tells how far behind it a value lies.
constexpr double kSurface = 1017.0;
constexpr double kColorSpan = 400.0; // units; within what a pre-integrated table holds exactly
constexpr double kLeastRed = 0.25;

TransferFunction stepTransfer(bool rises) {
    const glm::dvec3 atSurface(kLeastRed, 0.5, 0.0);
    const glm::dvec3 deep(1.0, 0.5, 0.0);
    if (rises) {
        return {.name = "step up",
                .points = {{kSurface, atSurface, 0.0},
                           {kSurface + 1.0, atSurface, 1.0},
                           {kSurface + 1.0 + kColorSpan, deep, 1.0}}};
    }
    return {.name = "step down",
            .points = {{kSurface - 1.0 - kColorSpan, deep, 1.0},
                       {kSurface - 1.0, atSurface, 1.0},
                       {kSurface, atSurface, 0.0}}};
}

/// How many layers the picture's colour is from the surface's, at most; all the way to the end
/// where a pixel shows no surface.
double layersFromSurface(const Picture& picture, double unitsPerLayer) {
    double most = 0.0;
    for (const glm::vec4& pixel : picture.pixels) {
        const double off = std::abs(static_cast<double>(pixel.r) - kLeastRed);
        const double units =
            pixel.a < 0.99F ? kDepth * kUnitsPerVoxel : off / (1.0 - kLeastRed) * kColorSpan;
        const double layers = units / unitsPerLayer;
        most = layers <= most ? most : layers;
    }
    return most;
}

void recordSteps(Bench& bench, bool rises, Classification classification, const Spacing& spacing) {
    const Result<Scene> scene = bench.scene(
        rampVolume(rises), {.tf = stepTransfer(rises), .classification = classification},
        {.structure = SkipStructure::None});
    const double unitsPerLayer = kUnitsPerVoxel * spacing.voxels * kCosine;
    for (const Method& method : methods()) {
        Case c{.family = "stiff",
               .name = named({rises ? "one-unit step up" : "one-unit step down",
                              name(classification), spacing.name, method.name}),
               .quantity = "distance of the colour from the surface's, layers",
               .reason = "the first sample beyond the surface, or the mean of the first interval "
                         "that is opaque, lies at most a layer behind it; and the step's own width "
                         "of a unit, what the filter may be off by in either sample (1/256 of the "
                         "cell's range and a step of the format), and two roundings of the "
                         "target, all as shares of a layer's change in value"};
        if (!scene) {
            bench.recordFailure(std::move(c), scene.error());
            continue;
        }
        const double rounding =
            2.0 * roundingPerPlane(method.target) / (1.0 - kLeastRed) * kColorSpan;
        c.bound = 1.0 + (1.0 + 2.0 * kValueError + rounding) / unitsPerLayer;
        Settings settings = settingsOf(method, spacing);
        settings.classification = classification;
        bench.examine(std::move(c), *scene, settings, distantView(*scene, kAzimuth, 2.0, kSize),
                      kSize, [&](Case& judged, const Drawn& drawn) {
                          judged.measured = layersFromSurface(drawn.picture, unitsPerLayer);
                          if (isShown(method)) {
                              judged.pictures.push_back({"surface", drawn.picture});
                          }
                      });
    }
}

// --- A spike that lies between two samples ---

struct Spike {
    Classification classification;
    const char* name;
    double opacityUnitMm;
    const char* reason;
};

constexpr double kSpikeOpacity = 0.9;
// Faint where it may be missed, since a sample that hits it stands for a layer of its material.
constexpr Spike kSpikes[] = {
    {Classification::Post, "faint spike of two units", 10.0,
     "a sample that hits the spike stands for a layer of its material, one that misses it for "
     "none: a midpoint rule is off by half the total variation of extinction x layer length, here "
     "the peak's extinction x length"},
    {Classification::Preintegrated, "spike of two units", 0.05,
     "an interval's mean extinction knows of all between its ends, so the spike is never lost: "
     "what "
     "the filter moves the two ends by (1/256 of the cell's range and a step of the format) "
     "changes "
     "the depth by their share of the interval; where an end lies between two texels of the table, "
     "at t, interpolating the means m0 and m1 changes the depth by t (1 - t) (m0 - m1) of a texel: "
     "an eighth of the spike at most on either side; opacity by 1/e of all that; fp16 table, "
     "2^-11 / e"}};

TransferFunction spikeTransfer(double opacityUnitMm) {
    const glm::dvec3 white(1.0);
    return {.name = "spike",
            .opacityUnitMm = opacityUnitMm,
            .points = {{kSurface - 1.0, white, 0.0},
                       {kSurface, white, kSpikeOpacity},
                       {kSurface + 1.0, white, 0.0}}};
}

double spikeBound(const Spike& spike, double unitsPerLayer, double layerMm) {
    if (spike.classification == Classification::Post) {
        const double peak = extinctionPerMm(kSpikeOpacity, spike.opacityUnitMm);
        return -std::expm1(-peak * layerMm);
    }
    // (n + t) ((1 - t) m0 + t m1) against n m0 (1 - t) + (n + 1) m1 t, for an interval from n
    // texels before m0's to t behind it. The spike is two texels wide, so the means of half of it
    // are at most half of its depth per texel.
    constexpr double kInterpolated = 2.0 * 0.25 * 0.5;
    const double ofDepth = 2.0 * kValueError / unitsPerLayer + kInterpolated;
    return (ofDepth + 0x1p-11) / std::exp(1.0);
}

void recordSpikes(Bench& bench, const Spike& spike, const Spacing& spacing) {
    const Result<Scene> scene = bench.scene(
        rampVolume(true),
        {.tf = spikeTransfer(spike.opacityUnitMm), .classification = spike.classification},
        {.structure = SkipStructure::None});
    for (const Method& method : methods()) {
        Case c{.family = "stiff",
               .name = named({spike.name, name(spike.classification), spacing.name, method.name}),
               .quantity = "largest difference from the integral, of full scale",
               .reason =
                   std::string(spike.reason) + "; " + kRoundingReason + ", three planes here"};
        if (!scene) {
            bench.recordFailure(std::move(c), scene.error());
            continue;
        }
        c.bound =
            spikeBound(spike, kUnitsPerVoxel * spacing.voxels * kCosine, spacing.voxels * 1.001) +
            3.0 * roundingPerPlane(method.target);
        Settings settings = settingsOf(method, spacing);
        settings.classification = spike.classification;
        const View view = distantView(*scene, kAzimuth, 2.0, kSize);
        bench.examine(
            std::move(c), *scene, settings, view, kSize, [&](Case& judged, const Drawn& drawn) {
                judged.measured =
                    largestDifference(drawn.picture, continuousPicture(*scene, view, kSize));
                if (isShown(method)) {
                    judged.pictures.push_back({"spike", drawn.picture});
                }
            });
    }
}

} // namespace

void stiffTransferCases(Bench& bench) {
    for (const Spacing& spacing : kSpacings) {
        for (const Classification classification : kClassifications) {
            recordSteps(bench, true, classification, spacing);
            if (!bench.reduced()) {
                recordSteps(bench, false, classification, spacing);
            }
        }
        for (const Spike& spike : kSpikes) {
            recordSpikes(bench, spike, spacing);
        }
    }
}

} // namespace slabcast::stability

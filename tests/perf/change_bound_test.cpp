#include "perf/stability/change_bound.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "perf/stability/perturbed_inputs.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {
namespace {

constexpr glm::ivec2 kSize(6, 6);
constexpr double kShare = 1e-4;

Texels texelsOf(double (*value)(glm::ivec3 v)) {
    const Volume volume = formulaVolume({9, 8, 7}, VoxelType::U8, value);
    return encodeTexels(volume, computeStatistics(volume), TexelFormat::Rg8Exact);
}

double waves(glm::ivec3 v) {
    return 120.0 + 80.0 * std::sin(0.9 * v.x) * std::cos(0.7 * v.y + 0.4 * v.z);
}

SampleSetup setupOf(const Texels& texels, TransferFunction tf) {
    const VolumeGeometry geometry{.dims = texels.dims};
    const BoundingSphere sphere = geometry.boundingSphere();
    return {.texels = &texels,
            .geometry = geometry,
            .tf = std::move(tf),
            .view = {.viewFromModel = viewFromModel({30.0, 20.0, 2.5}, sphere),
                     .frustum = symmetricFrustum(40.0, 1.0)},
            .lattice = {LatticeKind::Planar, layersToCover(sphere.radiusMm, 1.0), 1.0}};
}

TransferFunction ramps() {
    return {.points = {{30.0, {0.1, 0.4, 0.9}, 0.02},
                       {120.0, {0.8, 0.5, 0.3}, 0.12},
                       {230.0, {0.9, 0.7, 0.2}, 0.3}}};
}

/// Of an input that grows by `share`: the worst share of a pixel's bound, which is told `claimed`.
double worstShare(const SampleSetup& before, const Input& input, double share, double claimed) {
    SampleSetup after = before;
    input.grow(after, share);
    const ChangeBound bound(before, after, kSize, claimed, input.slopes);
    const std::vector<glm::dvec4> a = samplesOf(before, kSize);
    const std::vector<glm::dvec4> b = samplesOf(after, kSize);
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const glm::dvec4 off = glm::abs(b[i] - a[i]);
        const PixelChange allowed = bound.at(glm::dvec2(i % 6, i / 6) + 0.5);
        if (allowed.covered) {
            worst =
                std::max(worst, std::max({off.x, off.y, off.z, off.w}) / (allowed.bound + 1e-14));
        }
    }
    return worst;
}

TEST(ChangeBound, HoldsForEveryInputAndIsNotFarAboveTheChange) {
    const Texels texels = texelsOf(waves);
    const SampleSetup setup = setupOf(texels, ramps());
    for (const Input& input : perturbedInputs()) {
        const double share = worstShare(setup, input, kShare, kShare);
        EXPECT_LE(share, 1.0) << input.name;
        EXPECT_GE(share, 0.02) << input.name;
    }
}

TEST(ChangeBound, DoesNotHoldWhereAnInputGrowsBySixtyTimesWhatIsSaid) {
    const Texels texels = texelsOf(waves);
    const SampleSetup setup = setupOf(texels, ramps());
    for (const Input& input : perturbedInputs()) {
        if (input.slopes != nullptr) {
            EXPECT_GT(worstShare(setup, input, 60.0 * kShare, kShare), 1.0) << input.name;
        }
    }
}

/// All values lie on the step: it moves past them, and no other input does.
TEST(ChangeBound, TellsWhereASampleMayPassAStep) {
    const Texels texels = texelsOf([](glm::ivec3) { return 128.0; });
    TransferFunction step = ramps();
    step.points[1].value = 128.0;
    step.points.insert(step.points.begin() + 2, {128.0, {0.9, 0.6, 0.3}, 0.2});
    const SampleSetup setup = setupOf(texels, step);
    for (const Input& input : perturbedInputs()) {
        SampleSetup after = setup;
        input.grow(after, kShare);
        const ChangeBound bound(setup, after, kSize, kShare, input.slopes);
        const PixelChange middle = bound.at(glm::dvec2(3.5));
        EXPECT_TRUE(middle.covered);
        EXPECT_EQ(middle.meetsStep, std::string(input.name) == "value of a point") << input.name;
    }
}

} // namespace
} // namespace slabcast::stability

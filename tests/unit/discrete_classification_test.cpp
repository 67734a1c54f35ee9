#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/reference/discrete.h"
#include "tests/support/discrete_ray.h"
#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::axisRay;
using test::Dice;
using test::floatTexels;
using test::ObliqueRamp;
using test::onlyPixel;
using test::tfOf;

constexpr auto kDisplay = CompositingSpace::Display;
const glm::dvec3 kOrange(0.9, 0.5, 0.1);
const double kSpacingsMm[] = {100.0, 7.3, 1.0, 0.11}; // the first: one layer for all

double depthOf(glm::dvec4 pixel) {
    return -std::log1p(-pixel.w);
}

ClassifiedTexels classifiedBy(const TransferFunction& tf, const Texels& texels,
                              const VolumeGeometry& geometry, double highest,
                              double referenceLengthMm) {
    const TransferTable table = makeTable(tf, 0.0, highest, false, kDisplay);
    return classify(texels, geometry, table, {.referenceLengthMm = referenceLengthMm});
}

TEST(DiscretePreintegrated, AConstantIsExactWhateverTheLayers) {
    const VolumeGeometry geometry{.dims = {10, 20, 30}};
    const Texels texels = floatTexels(geometry, [](glm::ivec3) { return 1.0; });
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 0.05}});
    for (const double spacing : kSpacingsMm) {
        const glm::dvec4 pixel =
            onlyPixel(axisRay(texels, geometry, PreintegratedExact{tf}, {90.0, 0.0, 3.0}, spacing));
        EXPECT_NEAR(pixel.w, 1.0 - std::pow(0.95, 10.0), 1e-12) << spacing;
        EXPECT_NEAR(glm::distance(glm::dvec3(pixel), kOrange * pixel.w), 0.0, 1e-12) << spacing;
    }
}

// The field is linear along the ray, and linear in opacity is what the TF is; so the depth is known
// and no layer may be too long.
TEST(DiscretePreintegrated, ARampOfOpacityIsExactWhateverTheLayers) {
    const ObliqueRamp ramp;
    const double perValue = 0.05;
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 0.0},
                                      {.value = 16.0, .color = kOrange, .opacity = 16 * perValue}});
    const auto antiderivative = [](double u) { return (1.0 - u) * std::log(1.0 - u) + u; };
    const double du = perValue * ramp.risePerMm();
    const double u0 = perValue * ramp.first();
    const double depth = (antiderivative(u0 + du * ramp.lengthMm()) - antiderivative(u0)) / du;
    const PreintegratedTable table = makePreintegratedTable(tf, 0.0, 16.0, false, kDisplay);
    // Of a mean: a twelfth of its curve over a texel, and 2^-12 of it, and twice that at most where
    // it changes within a texel. See preintegrated_test.cpp.
    const double texel = 16.0 / (table.size() - 1);
    const double curve = std::pow(perValue / 0.2, 2.0);
    const double bound = ramp.lengthMm() * texel * texel * curve / 12.0 + 0x1p-11 * depth;
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const double spacing : kSpacingsMm) {
            DiscreteInput input =
                axisRay(ramp.texels, ramp.geometry, PreintegratedExact{tf}, ramp.camera, spacing);
            input.lattice.kind = kind;
            const glm::dvec4 exact = onlyPixel(input);
            EXPECT_NEAR(depthOf(exact), depth, 1e-10) << spacing;
            EXPECT_NEAR(glm::distance(glm::dvec3(exact), kOrange * exact.w), 0.0, 1e-12);
            input.transfer = table;
            EXPECT_NEAR(depthOf(onlyPixel(input)), depth, bound) << spacing;
        }
    }
}

TEST(DiscretePreintegrated, AStepThatALinearFieldCrossesIsExactToo) {
    const ObliqueRamp ramp;
    const double threshold = 6.3;
    const TransferFunction tf =
        tfOf({{.value = threshold, .opacity = 0.0}, {.value = threshold, .opacity = 0.4}});
    const double above = (ramp.first() - threshold) / -ramp.risePerMm(); // mm, from the entry on
    const double depth = -std::log(0.6) * above;
    for (const double spacing : kSpacingsMm) {
        DiscreteInput input =
            axisRay(ramp.texels, ramp.geometry, PreintegratedExact{tf}, ramp.camera, spacing);
        EXPECT_NEAR(depthOf(onlyPixel(input)), depth, 1e-10) << spacing;
    }
}

// Along the diagonal of one cell with a single corner the field is t^3: it crosses 1/2 at a known
// place. Its chord over a layer of h (in units of t) is off by up to h^2/8 of its curve, so is the
// place of the crossing, by its slope: order two. A sample in the middle may only tell on which
// side of it the crossing is: order one.
TEST(DiscretePreintegrated, AStepInACubicFieldConvergesWithOrderTwo) {
    const VolumeGeometry geometry{.dims = glm::ivec3(2)};
    const Texels texels =
        floatTexels(geometry, [](glm::ivec3 v) { return v == glm::ivec3(0, 1, 0) ? 1.0 : 0.0; });
    const TransferFunction tf =
        tfOf({{.value = 0.5, .opacity = 0.0}, {.value = 0.5, .opacity = 0.2}});
    const OrbitCamera camera{45.0, std::atan(std::sqrt(0.5)) * 180.0 / M_PI, 3.0};
    const double diagonal = std::sqrt(3.0);
    const double crossing = std::cbrt(0.5);
    const double depth = -std::log(0.8) * diagonal * (1.0 - crossing + 0.5);
    double worstShare = 0.0;
    double worstPost = 0.0;
    for (double spacing = 0.4; spacing > 0.004; spacing *= 0.83) {
        const double h = spacing / diagonal;
        const double least = crossing - h; // slope 3 t^2, curve 6 t
        const double bound =
            -std::log(0.8) * diagonal * h * h / 8.0 * 6.0 * (crossing + h) / (3.0 * least * least);
        const double error = std::abs(
            depthOf(onlyPixel(axisRay(texels, geometry, PreintegratedExact{tf}, camera, spacing))) -
            depth);
        EXPECT_LE(error, bound + 1e-12) << spacing;
        worstShare = std::max(worstShare, error / bound);
        const double post =
            std::abs(depthOf(onlyPixel(axisRay(texels, geometry, tf, camera, spacing))) - depth);
        worstPost = std::max(worstPost, post / (-std::log(0.8) * spacing));
    }
    EXPECT_GT(worstShare, 0.2); // it is no better than that
    EXPECT_GT(worstPost, 0.3);  // of a whole layer
}

// The colour of an interval is off by what preintegrated.h derives, at most: against layers so fine
// that theirs are not. The field is linear along the ray, so opacity is exact in both.
TEST(DiscretePreintegrated, ColoursAreWithinTheBoundThatIsReported) {
    const ObliqueRamp ramp;
    Dice dice(1);
    double worstShare = 0.0;
    for (int k = 0; k < 150; ++k) {
        std::vector<TransferPoint> points;
        for (int p = 0; p < 5; ++p) {
            const double value = 15.0 * p / 4.0;
            points.push_back({value, dice.inCube(0.0, 1.0), dice.uniform(0.0, 0.9)});
            if (dice.chance(0.3)) {
                points.push_back({value, dice.inCube(0.0, 1.0), dice.uniform(0.0, 0.9)});
            }
        }
        const TransferFunction tf = tfOf(std::move(points), dice.logUniform(0.3, 100.0));
        DiscreteInput input =
            axisRay(ramp.texels, ramp.geometry, PreintegratedExact{tf}, ramp.camera, 0.005);
        input.space = dice.chance(0.5) ? kDisplay : CompositingSpace::Linear;
        double most = 0.0;
        for (const TransferPoint& point : tf.points) {
            most = std::max(most, extinctionPerMm(point.opacity, tf.opacityUnitMm));
        }
        const double range = visibleColorRange(tf, 0.0, 15.0, input.space);
        const auto boundAt = [&](double mm) { return range * preintegratedColorError(most * mm); };
        const glm::dvec4 fine = onlyPixel(input);
        for (const double spacing : {40.0, 5.0, 1.3, 0.4}) {
            input.lattice.spacingMm = spacing;
            input.lattice.total = layersToCover(ramp.geometry.boundingSphere().radiusMm, spacing);
            const glm::dvec4 off = glm::abs(onlyPixel(input) - fine);
            EXPECT_NEAR(off.w, 0.0, 1e-10);
            const double error = std::max({off.x, off.y, off.z});
            EXPECT_LE(error, boundAt(spacing) + boundAt(0.005) + 1e-10) << spacing;
            worstShare = std::max(worstShare, error / boundAt(spacing));
        }
    }
    EXPECT_GT(worstShare, 0.1);
}

// Between two voxels, one empty and one not: the texel half way is half of the full one.
TEST(DiscretePreclassified, FiltersPremultipliedColours) {
    const VolumeGeometry geometry{.dims = {2, 5, 5}};
    const Texels texels = floatTexels(geometry, [](glm::ivec3 v) { return v.x; });
    const double opacity = 0.6; // of a reference layer of 2.5 mm
    const TransferFunction tf = tfOf({{.value = 0.5, .color = glm::dvec3(1.0), .opacity = 0.0},
                                      {.value = 0.5, .color = kOrange, .opacity = opacity}},
                                     2.5);
    for (const double spacing : kSpacingsMm) {
        // Along z, through x = 1/2.
        const glm::dvec4 pixel = onlyPixel(
            axisRay(texels, geometry, PreclassifiedExact{tf, 2.5}, {0.0, 90.0, 3.0}, spacing));
        EXPECT_NEAR(pixel.w, 1.0 - std::pow(1.0 - opacity / 2.0, 5.0 / 2.5), 1e-12) << spacing;
        EXPECT_NEAR(glm::distance(glm::dvec3(pixel), kOrange * pixel.w), 0.0, 1e-12);
    }
}

TEST(DiscretePreclassified, AnOpaqueVoxelHidesAllButNothing) {
    const VolumeGeometry geometry{.dims = glm::ivec3(3)};
    const Texels texels = floatTexels(geometry, [](glm::ivec3) { return 1.0; });
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 1.0}});
    const ClassifiedTexels classified = classifiedBy(tf, texels, geometry, 1.0, 1.0);
    ASSERT_EQ(classified.texels[0].w, 255);
    for (const DiscreteTransfer& transfer :
         {DiscreteTransfer(PreclassifiedExact{tf, 1.0}), DiscreteTransfer(&classified)}) {
        const glm::dvec4 pixel =
            onlyPixel(axisRay(texels, geometry, transfer, {0.0, 0.0, 3.0}, 0.1));
        EXPECT_NEAR(pixel.w, 1.0, 1e-12);
        EXPECT_NEAR(pixel.x, kOrange.x, 0.5 / 255.0 + 0x1p-12); // and a half of the table
    }
}

// Stored texels are off by half a step of 8 bits, in alpha and in premultiplied colour.
TEST(DiscretePreclassified, StoredTexelsDifferByTheirEightBits) {
    const ObliqueRamp ramp;
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 1.0, 0.2}, .opacity = 0.1},
                                      {.value = 15.0, .color = kOrange, .opacity = 0.6}});
    const double referenceMm = 1.0;
    const ClassifiedTexels classified =
        classifiedBy(tf, ramp.texels, ramp.geometry, 15.0, referenceMm);
    const double spacing = 0.7;
    const glm::dvec4 exact = onlyPixel(axisRay(
        ramp.texels, ramp.geometry, PreclassifiedExact{tf, referenceMm}, ramp.camera, spacing));
    const glm::dvec4 stored =
        onlyPixel(axisRay(ramp.texels, ramp.geometry, &classified, ramp.camera, spacing));
    // A layer of k reference lengths: alpha moves by k (1 - a)^(k - 1) of what the texel is off by,
    // at most 0.7 * 0.4^-0.3 here; colour by as much of its own, and by alpha's again. What is in
    // front weighs at least as much as what is behind: the sum of weights is at most 1 / alpha.
    const double step = 0.5 / 255.0 + 0x1p-11; // of the table, too
    const double layer = step * 0.7 * std::pow(0.4, -0.3);
    const double leastAlpha = 1.0 - std::pow(0.9, 0.7);
    EXPECT_NE(stored, exact);
    EXPECT_NEAR(stored.w, exact.w, layer / leastAlpha);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(stored[channel], exact[channel], 3.0 * layer / leastAlpha) << channel;
    }
}

TEST(DiscretePreclassified, FilteringCommutesWhereColoursAreLinear) {
    // Constant opacity and colour linear in value: filtering before or after is the same.
    const ObliqueRamp ramp;
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 0.0, 1.0}, .opacity = 0.1},
                                      {.value = 15.0, .color = {1.0, 0.0, 1.0}, .opacity = 0.1}});
    for (const double spacing : kSpacingsMm) {
        DiscreteInput input = axisRay(ramp.texels, ramp.geometry, tf, ramp.camera, spacing);
        const glm::dvec4 post = onlyPixel(input);
        input.transfer = PreclassifiedExact{tf, 1.0};
        EXPECT_NEAR(glm::distance(onlyPixel(input), post), 0.0, 1e-12) << spacing;
    }
}

} // namespace
} // namespace slabcast

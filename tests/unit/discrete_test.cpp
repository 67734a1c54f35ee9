#include "core/reference/discrete.h"

#include <gtest/gtest.h>

#include "tests/support/discrete_ray.h"
#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::axisRay;
using test::Dice;
using test::floatTexels;
using test::FrameScene;
using test::ObliqueRamp;
using test::onlyPixel;
using test::tfOf;
using test::volumeOf;

const glm::dvec3 kOrange(0.9, 0.5, 0.1);

TEST(Discrete, ConstantDensityIsExactWhateverTheLayers) {
    const double opacity = 0.3;
    const double unitMm = 20.0;
    const TransferFunction tf =
        tfOf({{.value = 5.0, .color = kOrange, .opacity = opacity}}, unitMm);
    Dice dice(1);
    int hit = 0;
    for (int k = 0; k < 300; ++k) {
        FrameScene scene = test::randomScene(dice, 1 + dice.below(300));
        const BoundingSphere sphere = scene.geometry.boundingSphere();
        const OrbitCamera camera{dice.uniform(0.0, 360.0), dice.uniform(-90.0, 90.0),
                                 dice.uniform(0.0, 4.0)};
        scene.view.viewFromModel = viewFromModel(camera, sphere);
        scene.view.nearDepth = dice.chance(0.5) ? 0.0 : dice.uniform(0.0, 2.0) * sphere.radiusMm;
        scene.viewport = {dice.below(9), dice.below(9), 6, 5};
        const Texels texels = floatTexels(scene.geometry, [](glm::ivec3) { return 7.0; });
        const std::vector<glm::dvec4> pixels = renderDiscrete({.texels = &texels,
                                                               .geometry = scene.geometry,
                                                               .transfer = tf,
                                                               .view = scene.view,
                                                               .viewport = scene.viewport,
                                                               .lattice = scene.lattice});
        ASSERT_EQ(pixels.size(), 30U);
        for (int pixel = 0; pixel < 30; ++pixel) {
            const glm::dvec2 at(scene.viewport.x + pixel % 6 + 0.5,
                                scene.viewport.y + pixel / 6 + 0.5);
            const double lengthMm = test::lengthInsideMm(scene, at);
            const double alpha = 1.0 - std::pow(1.0 - opacity, lengthMm / unitMm);
            EXPECT_NEAR(pixels[pixel].w, alpha, 1e-12) << "view " << k << ", pixel " << pixel;
            EXPECT_NEAR(glm::distance(glm::dvec3(pixels[pixel]), kOrange * alpha), 0.0, 1e-12);
            hit += alpha > 0.0;
        }
    }
    EXPECT_GT(hit, 3000);
}

TEST(Discrete, TheChordThroughABoxIsItsEdge) {
    const VolumeGeometry geometry{.dims = {10, 20, 30}};
    const Texels texels = floatTexels(geometry, [](glm::ivec3) { return 1.0; });
    const TransferFunction tf = tfOf({{.value = 0.0, .opacity = 0.05}});
    const struct {
        OrbitCamera camera;
        double chordMm;
    } cases[] = {{{90.0, 0.0, 3.0}, 10.0},
                 {{0.0, 0.0, 3.0}, 20.0},
                 {{0.0, 90.0, 3.0}, 30.0},
                 {{0.0, 0.0, 0.0}, 10.0}};
    for (const auto& c : cases) {
        for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
            for (const double spacingMm : {100.0, 7.3, 1.0, 0.11}) { // few of them divide anything
                DiscreteInput input = axisRay(texels, geometry, tf, c.camera, spacingMm);
                input.lattice.kind = kind;
                EXPECT_NEAR(onlyPixel(input).w, 1.0 - std::pow(0.95, c.chordMm), 1e-12)
                    << spacingMm;
            }
        }
    }
}

TEST(Discrete, ARampOfOpacityConvergesWithOrderTwo) {
    const ObliqueRamp ramp;
    const double perValue = 0.05; // opacity = perValue * value, of 1 mm
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 0.0},
                                      {.value = 16.0, .color = kOrange, .opacity = 16 * perValue}});
    // The integral of -ln(1 - u) is (1 - u) ln(1 - u) + u, with u = perValue * (first + rise * s).
    const double length = ramp.lengthMm();
    const double du = perValue * ramp.risePerMm();
    const auto antiderivative = [](double u) { return (1.0 - u) * std::log(1.0 - u) + u; };
    const double u0 = perValue * ramp.first();
    const double depth = (antiderivative(u0 + du * length) - antiderivative(u0)) / du;
    // Error of the midpoint rule, and at both ends of a part w of a layer that is sampled in the
    // whole one's middle: w (1 - w) / 2 layers off, at most an eighth of a layer times the slope.
    const double slope = std::abs(du) / (1.0 - u0);
    const double bound = length / 24.0 * slope * slope + 2.0 * slope / 8.0;
    for (const double coarse : {1.0, 0.83, 0.37}) {
        double first = 0.0;
        double last = 0.0;
        for (int halvings = 0; halvings < 6; ++halvings) {
            const double spacing = std::ldexp(coarse, -halvings);
            const glm::dvec4 pixel =
                onlyPixel(axisRay(ramp.texels, ramp.geometry, tf, ramp.camera, spacing));
            last = std::abs(-std::log1p(-pixel.w) - depth);
            first = halvings == 0 ? last : first;
            EXPECT_LE(last, bound * spacing * spacing * 1.001) << spacing;
            EXPECT_NEAR(glm::distance(glm::dvec3(pixel), kOrange * pixel.w), 0.0, 1e-12);
        }
        EXPECT_GT(first, 0.0);
    }
}

TEST(Discrete, ALayerGridThatFitsConvergesWithOrderTwoExactly) {
    // Along z, with layers that end where the field's slope changes: half a voxel inside the box.
    const VolumeGeometry geometry{.dims = glm::ivec3(16)};
    const Texels texels = floatTexels(geometry, [](glm::ivec3 v) { return v.z; });
    const TransferFunction tf =
        tfOf({{.value = 0.0, .opacity = 0.0}, {.value = 15.0, .opacity = 0.9}});
    const double a = 0.9 / 15.0;
    const double inner = ((1.0 - 0.9) * std::log(1.0 - 0.9) + 0.9) / a;
    const double depth =
        inner - 0.5 * std::log(1.0 - 0.9); // the outer half voxels: 0 below, 0.9 above
    std::vector<double> errors;
    for (int halvings = 0; halvings < 5; ++halvings) {
        DiscreteInput input =
            axisRay(texels, geometry, tf, {0.0, 90.0, 3.0}, std::ldexp(0.5, -halvings));
        input.lattice.total = 64 << halvings; // even: a layer ends in the centre
        errors.push_back(std::abs(-std::log1p(-onlyPixel(input).w) - depth));
    }
    for (std::size_t k = 1; k < errors.size(); ++k) {
        EXPECT_NEAR(std::log2(errors[k - 1] / errors[k]), 2.0, 0.1) << k;
    }
}

TEST(Discrete, ColoursAreCompositedFrontToBack) {
    // Constant extinction s, red rising linearly along the ray: integral of (c + d t) s exp(-s t)
    // over the length.
    ObliqueRamp ramp;
    const double opacity = 0.1;
    const TransferFunction tf =
        tfOf({{.value = 0.0, .color = {0.0, 0.0, 1.0}, .opacity = opacity},
              {.value = 15.0, .color = {1.0, 0.0, 1.0}, .opacity = opacity}});
    const double s = -std::log(1.0 - opacity);
    const double length = ramp.lengthMm();
    const double rest = std::exp(-s * length);
    for (const double side : {1.0, -1.0}) { // from above and from below
        ramp.camera.elevationDegrees = 30.0 * side;
        const double first = (side > 0.0 ? ramp.first() : 15.0 - ramp.first()) / 15.0;
        const double rise = side * ramp.risePerMm() / 15.0;
        const double red = first * (1.0 - rest) + rise * ((1.0 - rest) / s - length * rest);
        // A layer's colour is that of its middle: h^2 / 12 by the curve of exp(-s t), and an eighth
        // at either end.
        const double bound = std::abs(rise) * s * (1.0 / 12.0 + 2.0 / 8.0);
        for (const double spacing : {0.4, 0.1, 0.025}) {
            const glm::dvec4 pixel =
                onlyPixel(axisRay(ramp.texels, ramp.geometry, tf, ramp.camera, spacing));
            EXPECT_NEAR(pixel.x, red, bound * spacing * spacing) << spacing;
            EXPECT_NEAR(pixel.z, 1.0 - rest, 1e-12);
        }
    }
}

TEST(Discrete, TheSpaceIsThatOfTheColours) {
    const VolumeGeometry geometry{.dims = glm::ivec3(4)};
    const Texels texels = floatTexels(geometry, [](glm::ivec3) { return 1.0; });
    const TransferFunction tf = tfOf({{.value = 0.0, .color = glm::dvec3(0.5), .opacity = 0.2}});
    DiscreteInput input = axisRay(texels, geometry, tf, {}, 0.3);
    const glm::dvec4 display = onlyPixel(input);
    EXPECT_NEAR(display.x, 0.5 * display.w, 1e-12);
    input.space = CompositingSpace::Linear;
    const glm::dvec4 linear = onlyPixel(input);
    EXPECT_NEAR(linear.x, 0.21404114 * linear.w, 1e-8); // IEC 61966-2-1 of 0.5
    EXPECT_EQ(linear.w, display.w);
}

TEST(Discrete, ATableGivesWhatItsTexelsSay) {
    const ObliqueRamp ramp;
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 0.0},
                                      {.value = 15.0, .color = kOrange, .opacity = 0.4}});
    DiscreteInput input = axisRay(ramp.texels, ramp.geometry, tf, ramp.camera, 0.1);
    const glm::dvec4 continuous = onlyPixel(input);
    input.transfer = makeTable(tf, 0.0, 15.0, false, CompositingSpace::Display, 1024);
    const glm::dvec4 table = onlyPixel(input);
    EXPECT_NE(table, continuous);
    EXPECT_NEAR(glm::distance(table, continuous), 0.0, 2.0 * 0x1p-11); // fp16 texels
    // A table by hand: extinction 0 at value 0, 1 at value 15, linear between.
    input.transfer = TransferTable{0.0, 15.0, {glm::vec4(1.0F, 1.0F, 1.0F, 0.0F), glm::vec4(1.0F)}};
    EXPECT_NEAR(onlyPixel(input).w, 1.0 - std::exp(-0.5 * ramp.lengthMm()),
                1e-12); // symmetric: the mean of the ramp
}

TEST(Discrete, ShadesByTheGradientInPatientSpace) {
    ObliqueRamp ramp; // gradient: half a unit per mm, along z; the ray meets it at 60 degrees
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 0.1}});
    const double facing = 0.5;
    const ShadingParameters model{
        .ambient = 0.2, .diffuse = 0.6, .specular = 0.3, .shininess = 3.0};
    const glm::dvec3 lit = kOrange * (0.2 + 0.6 * facing) + 0.3 * facing * facing * facing;
    const struct {
        double floor;
        double weight; // smoothstep from the floor to twice the floor
    } cases[] = {{0.0, 1.0}, {0.2, 1.0}, {0.5 / 1.5, 0.5}, {0.5 / 1.25, 0.15625},
                 {0.5, 0.0}, {2.0, 0.0}};
    for (const auto& c : cases) {
        DiscreteInput input = axisRay(ramp.texels, ramp.geometry, tf, ramp.camera, 0.7);
        input.shading = model;
        input.shading->gradientFloorPerMm = c.floor;
        const glm::dvec4 pixel = onlyPixel(input);
        const glm::dvec3 expected = glm::mix(kOrange, lit, c.weight) * pixel.w;
        EXPECT_NEAR(glm::distance(glm::dvec3(pixel), expected), 0.0, 1e-12) << c.floor;
    }
    DiscreteInput bright = axisRay(ramp.texels, ramp.geometry, tf, ramp.camera, 0.7);
    bright.shading = ShadingParameters{.ambient = 5.0};
    const glm::dvec4 pixel = onlyPixel(bright);
    EXPECT_NEAR(
        glm::distance(glm::dvec3(pixel),
                      glm::dvec3(glm::min(kOrange * 5.375 + 0.25 * std::pow(0.5, 32.0), 1.0)) *
                          pixel.w),
        0.0, 1e-12);
}

TEST(Discrete, EveryFormatHoldsTheSameField) {
    const VolumeGeometry geometry{.dims = {5, 7, 6}, .direction = Dice(3).rotation()};
    const auto value = [](glm::ivec3 v) { return (v.x * 53 + v.y * 31 + v.z * 97) % 256; };
    const Volume volume = volumeOf<std::uint8_t>(geometry, VoxelType::U8, value);
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 1.0, 0.2}, .opacity = 0.0},
                                      {.value = 255.0, .color = kOrange, .opacity = 0.6}});
    const Texels reference = floatTexels(geometry, value);
    DiscreteInput input = axisRay(reference, geometry, tf, {}, 0.21);
    input.viewport = {0, 0, 12, 10};
    input.shading = ShadingParameters{};
    const std::vector<glm::dvec4> expected = renderDiscrete(input);
    for (const TexelFormat format : {TexelFormat::R8, TexelFormat::R16, TexelFormat::R16F,
                                     TexelFormat::Rg8Exact, TexelFormat::R32fExact}) {
        const Texels texels = encodeTexels(volume, computeStatistics(volume), format);
        ASSERT_EQ(texels.maxQuantisationError, 0.0);
        input.texels = &texels;
        const std::vector<glm::dvec4> pixels = renderDiscrete(input);
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            EXPECT_NEAR(glm::distance(pixels[k], expected[k]), 0.0, 1e-11) << name(format);
        }
    }
}

TEST(Discrete, NothingIsWhereNoRayMeetsTheBox) {
    const VolumeGeometry geometry{.dims = glm::ivec3(8)};
    const Texels texels = floatTexels(geometry, [](glm::ivec3) { return 1.0; });
    const TransferFunction tf = tfOf({{.value = 0.0, .opacity = 0.5}});
    DiscreteInput input = axisRay(texels, geometry, tf, {}, 1.0);
    input.viewport = {0, 0, 9, 9};
    input.view.frustum = symmetricFrustum(60.0, 1.0);
    const std::vector<glm::dvec4> seen = renderDiscrete(input);
    EXPECT_GT(seen[40].w, 0.9);                                      // the middle
    EXPECT_EQ(seen[0], glm::dvec4(0.0));                             // beside the box
    input.view.nearDepth = 4.0 * geometry.boundingSphere().radiusMm; // all of it is nearer
    for (const glm::dvec4& pixel : renderDiscrete(input)) {
        EXPECT_EQ(pixel, glm::dvec4(0.0));
    }
    input.view.nearDepth = 0.0;
    input.view.viewFromModel = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, -1.0)) *
                               input.view.viewFromModel; // about-face
    for (const glm::dvec4& pixel : renderDiscrete(input)) {
        EXPECT_EQ(pixel, glm::dvec4(0.0));
    }
}

} // namespace
} // namespace slabcast

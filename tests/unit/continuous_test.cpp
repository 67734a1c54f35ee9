#include "core/reference/continuous.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using test::floatTexels;
using test::FrameScene;
using test::ObliqueRamp;
using test::tfOf;

const glm::dvec3 kOrange(0.9, 0.5, 0.1);
const glm::dvec3 kBlue(0.1, 0.2, 0.8);

/// One ray along the view's axis, through the centre of the volume.
ContinuousInput axisRay(const Texels& texels, const VolumeGeometry& geometry,
                        const TransferFunction& tf, const OrbitCamera& camera) {
    ContinuousInput input;
    input.texels = &texels;
    input.geometry = geometry;
    input.tf = tf;
    input.view = {viewFromModel(camera, geometry.boundingSphere()), symmetricFrustum(30.0, 1.0),
                  0.0};
    input.viewport = {0, 0, 1, 1};
    return input;
}

glm::dvec4 onlyPixel(const ContinuousInput& input) {
    return integrateRay(input, {0.5, 0.5});
}

glm::dvec4 over(glm::dvec4 front, glm::dvec4 back) {
    return front + (1.0 - front.w) * back;
}

/// A layer of one material.
glm::dvec4 layerOf(glm::dvec3 color, double opacity, double lengthInUnits) {
    const double alpha = -std::expm1(lengthInUnits * std::log1p(-opacity));
    return {color * alpha, alpha};
}

void expectSame(glm::dvec4 pixel, glm::dvec4 expected, double tolerance) {
    for (int channel = 0; channel < 4; ++channel) {
        EXPECT_NEAR(pixel[channel], expected[channel], tolerance * expected.w) << channel;
    }
}

/// A volume, a TF and a view of it, all at random.
struct Chance {
    FrameScene scene;
    Texels texels;
    TransferFunction tf;
    ContinuousInput input;
};

TransferFunction randomTransfer(Dice& dice, bool steps) {
    std::vector<TransferPoint> points;
    double value = -1.0;
    const int count = 1 + dice.below(6);
    for (int k = 0; k < count; ++k) {
        const bool step = steps && k % 2 == 1;
        value += step ? 0.0 : dice.uniform(0.5, 4.0);
        const double opacity = dice.chance(0.3) ? 0.0 : std::pow(dice.uniform(0.0, 0.99), 3.0);
        points.push_back({.value = value, .color = dice.inCube(0.0, 1.0), .opacity = opacity});
    }
    return tfOf(std::move(points));
}

Chance chanceOf(Dice& dice, bool steps) {
    Chance chance;
    chance.scene = test::randomScene(dice, 1);
    VolumeGeometry& geometry = chance.scene.geometry;
    for (int axis = 0; axis < 3; ++axis) { // fewer voxels in the same box
        const int dim = 1 + dice.below(7);
        geometry.spacingMm[axis] *= static_cast<double>(geometry.dims[axis]) / dim;
        geometry.originMm += geometry.direction[axis] * geometry.spacingMm[axis] * 0.5;
        geometry.dims[axis] = dim;
    }
    if (dice.chance(0.1)) {
        geometry.spacingMm[dice.below(3)] *= 1000.0;
    }
    chance.texels = floatTexels(geometry, [&](glm::ivec3) { return dice.uniform(0.0, 10.0); });
    chance.tf = randomTransfer(dice, steps);
    chance.tf.opacityUnitMm = geometry.boundingSphere().radiusMm * dice.logUniform(0.05, 5.0);
    chance.input.geometry = geometry;
    chance.input.tf = chance.tf;
    chance.input.space = dice.chance(0.5) ? CompositingSpace::Display : CompositingSpace::Linear;
    chance.input.view = chance.scene.view;
    chance.input.viewport = chance.scene.viewport;
    return chance;
}

// ---- closed forms

TEST(Continuous, ConstantDensityIsBeersLaw) {
    Dice dice(1);
    int hit = 0;
    for (int k = 0; k < 400; ++k) {
        const FrameScene scene = test::randomScene(dice, 1);
        const double opacity = dice.chance(0.2) ? kMaxOpacity : dice.logUniform(1e-9, 0.99);
        const double unitMm = scene.geometry.boundingSphere().radiusMm * dice.logUniform(1e-3, 1e6);
        const TransferFunction tf =
            tfOf({{.value = 5.0, .color = kOrange, .opacity = opacity}}, unitMm);
        const Texels texels = floatTexels(scene.geometry, [](glm::ivec3) { return 7.0; });
        const ContinuousInput input{.texels = &texels,
                                    .geometry = scene.geometry,
                                    .tf = tf,
                                    .view = scene.view,
                                    .viewport = scene.viewport};
        const double distanceMm = glm::length(glm::dvec3(scene.view.viewFromModel[3])) /
                                  glm::length(glm::dvec3(scene.view.viewFromModel[0]));
        for (int pixel = 0; pixel < 5; ++pixel) {
            const glm::dvec2 at = test::randomFragCoord(dice, scene);
            const double lengthMm = test::lengthInsideMm(scene, at);
            // The view's matrix and the pixel's place round: the ray ends move by a few 2^-53 of
            // how far away they are, more where it grazes a face.
            const double tolerance = 1e-10 + 64.0 * 0x1p-53 * distanceMm / lengthMm;
            expectSame(integrateRay(input, at), layerOf(kOrange, opacity, lengthMm / unitMm),
                       std::min(tolerance, 1.0));
            hit += tolerance < 1e-8;
        }
    }
    EXPECT_GT(hit, 700);
}

TEST(Continuous, ALinearRampOfOpacity) {
    ObliqueRamp ramp;
    const double perValue = kMaxOpacity / 15.0; // up to full opacity at the last voxel
    for (const double unitMm : {1e-6, 1.0, 40.0, 1e9}) {
        const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 0.0},
                                          {.value = 15.0, .color = kOrange, .opacity = 1.0}},
                                         unitMm);
        // The integral of -ln(1 - u) is (1 - u) ln(1 - u) + u, with u = perValue (first + rise s).
        const double length = ramp.lengthMm();
        const auto antiderivative = [](double u) { return (1.0 - u) * std::log1p(-u) + u; };
        const double u0 = perValue * ramp.first();
        const double du = perValue * ramp.risePerMm();
        const double depth = (antiderivative(u0 + du * length) - antiderivative(u0)) / du / unitMm;
        for (const double elevation : {30.0, -30.0}) { // from either side
            ramp.camera.elevationDegrees = elevation;
            const glm::dvec4 pixel =
                onlyPixel(axisRay(ramp.texels, ramp.geometry, tf, ramp.camera));
            const double alpha = -std::expm1(-depth);
            expectSame(pixel, glm::dvec4(kOrange, 1.0) * alpha, 1e-10);
        }
    }
}

TEST(Continuous, AStepInARampIsASurface) {
    const ObliqueRamp ramp;
    for (const double at : {5.5, 7.5, 9.123456789}) {
        const TransferFunction tf = tfOf({{.value = at, .color = kBlue, .opacity = 0.02},
                                          {.value = at, .color = kOrange, .opacity = 0.01}});
        // The ray goes down: orange until the value falls to the step, blue behind.
        const double frontMm = (at - ramp.first()) / ramp.risePerMm();
        const glm::dvec4 expected =
            over(layerOf(kOrange, 0.01, frontMm), layerOf(kBlue, 0.02, ramp.lengthMm() - frontMm));
        expectSame(onlyPixel(axisRay(ramp.texels, ramp.geometry, tf, ramp.camera)), expected,
                   1e-10);
    }
}

TEST(Continuous, AnOpaqueSurfaceHasTheColourOfItsStep) {
    const ObliqueRamp ramp;
    // Blue haze in front, then a wall: opacity 1 of a picometre, orange only at its surface.
    const double unitMm = 1e-9;
    const double haze = 1e-12;
    const TransferFunction tf = tfOf({{.value = 0.0, .color = kOrange, .opacity = 1.0},
                                      {.value = 6.0, .color = kOrange, .opacity = 1.0},
                                      {.value = 6.0, .color = kBlue, .opacity = haze}},
                                     unitMm);
    const double frontMm = (6.0 - ramp.first()) / ramp.risePerMm();
    const glm::dvec4 front = layerOf(kBlue, haze, frontMm / unitMm);
    ASSERT_GT(front.w, 0.001);
    expectSame(onlyPixel(axisRay(ramp.texels, ramp.geometry, tf, ramp.camera)),
               over(front, glm::dvec4(kOrange, 1.0)), 1e-10);
}

TEST(Continuous, AStiffRampShowsTheColourOfItsFront) {
    const ObliqueRamp ramp;
    // Extinction s, constant and huge; red falls along the ray by r per mm: red = first - r / s.
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 0.0, 1.0}, .opacity = 0.5},
                                      {.value = 15.0, .color = {1.0, 0.0, 1.0}, .opacity = 0.5}},
                                     1e-7);
    const double extinction = std::log(2.0) / 1e-7;
    const double red = (ramp.first() + ramp.risePerMm() / extinction) / 15.0;
    expectSame(onlyPixel(axisRay(ramp.texels, ramp.geometry, tf, ramp.camera)),
               {red, 0.0, 1.0, 1.0}, 1e-10);
}

/// value = x y in voxels, which trilinear interpolation keeps exactly: along the diagonal through
/// the centre it is 7.5^2 - r^2 with r the distance from the middle, in voxels per axis.
struct Shells {
    VolumeGeometry geometry{.dims = {16, 16, 3}};
    OrbitCamera camera{.azimuthDegrees = 45.0, .elevationDegrees = 0.0, .distanceRadii = 2.0};
    Texels texels = floatTexels(geometry, [](glm::ivec3 v) { return v.x * v.y; });

    static double radiusMm(double value) { return std::sqrt(2.0 * (56.25 - value)); }
};

TEST(Continuous, NestedShellsAlongAChord) {
    const Shells shells;
    const struct {
        double fromValue;
        double opacity;
        glm::dvec3 color;
    } layers[] = {{0.0, 0.0, kBlue},
                  {10.0, 0.01, kBlue},
                  {25.0, 0.2, kOrange},
                  {40.5, 0.0, kBlue},
                  {56.0, 0.9, glm::dvec3(1.0)}};
    std::vector<TransferPoint> points;
    for (std::size_t k = 0; k + 1 < std::size(layers); ++k) {
        points.push_back({layers[k].fromValue, layers[k].color, layers[k].opacity});
        points.push_back({layers[k + 1].fromValue, layers[k].color, layers[k].opacity});
    }
    points.push_back({56.0, glm::dvec3(1.0), 0.9});
    glm::dvec4 expected = layerOf(glm::dvec3(1.0), 0.9, 2.0 * Shells::radiusMm(56.0));
    for (int k = 3; k >= 1; --k) {
        const double thickness =
            Shells::radiusMm(layers[k].fromValue) - Shells::radiusMm(layers[k + 1].fromValue);
        const glm::dvec4 layer = layerOf(layers[k].color, layers[k].opacity, thickness);
        expected = over(layer, over(expected, layer));
    }
    expectSame(onlyPixel(axisRay(shells.texels, shells.geometry, tfOf(points), shells.camera)),
               expected, 1e-10);
}

TEST(Continuous, AShellThatTheRayOnlyTouches) {
    const Shells shells;
    for (const double inside : {1e-2, 1e-6, 1e-10}) { // the top of the parabola above the step
        const double step = 56.25 - inside;
        const TransferFunction tf =
            tfOf({{.value = step, .opacity = 0.0}, {.value = step, .opacity = 0.5}});
        const double alpha =
            onlyPixel(axisRay(shells.texels, shells.geometry, tf, shells.camera)).w;
        const double expected = layerOf({}, 0.5, 2.0 * Shells::radiusMm(step)).w;
        // The field's last digits, 2^-46, are a share of what is inside; half of it is the chord's.
        EXPECT_NEAR(alpha / expected, 1.0, 1e-10 + 0x1p-44 / inside) << inside;
    }
    const TransferFunction above =
        tfOf({{.value = 56.2501, .opacity = 0.0}, {.value = 56.2501, .opacity = 0.5}});
    EXPECT_EQ(onlyPixel(axisRay(shells.texels, shells.geometry, above, shells.camera)).w, 0.0);
}

// ---- special rays

TEST(Continuous, RaysThroughVoxelCentresAlongEdgesAndFacesSeeOneRow) {
    Dice dice(5);
    for (const double azimuth : {90.0, -90.0}) {
        for (const glm::ivec2 across : {glm::ivec2(1), glm::ivec2(5), glm::ivec2(5, 1)}) {
            std::vector<double> row;
            for (int k = 0; k < 12; ++k) {
                row.push_back(dice.uniform(0.0, 10.0));
            }
            const TransferFunction tf = randomTransfer(dice, true);
            const VolumeGeometry single{.dims = {12, 1, 1}};
            const Texels alone = floatTexels(
                single, [&](glm::ivec3 v) { return row[static_cast<std::size_t>(v.x)]; });
            // An odd number across: the middle row's centres lie on the axis, noise around it.
            const VolumeGeometry around{.dims = {12, across.x, across.y}};
            const Texels middle = floatTexels(around, [&](glm::ivec3 v) {
                const bool central = v.y == across.x / 2 && v.z == across.y / 2;
                return central ? row[static_cast<std::size_t>(v.x)] : dice.uniform(-9.0, 20.0);
            });
            // An even number: the axis lies on voxel faces, two equal rows or four.
            const VolumeGeometry doubled{.dims = {12, 2 * across.x, 2 * across.y}};
            const Texels between = floatTexels(doubled, [&](glm::ivec3 v) {
                const bool central = (v.y - 1) / 2 == (across.x - 1) / 2 && v.y > 0;
                const bool inMiddle = std::abs(2 * v.y - (2 * across.x - 1)) == 1 &&
                                      std::abs(2 * v.z - (2 * across.y - 1)) == 1;
                return inMiddle ? row[static_cast<std::size_t>(v.x)] : central ? 20.0 : -9.0;
            });
            const OrbitCamera camera{azimuth, 0.0, 3.0};
            const glm::dvec4 expected = onlyPixel(axisRay(alone, single, tf, camera));
            // Off the axis by rounding, 1e-15 voxels, noise of 30 comes in with 3e-14.
            expectSame(onlyPixel(axisRay(middle, around, tf, camera)), expected, 1e-10);
            expectSame(onlyPixel(axisRay(between, doubled, tf, camera)), expected, 1e-10);
        }
    }
}

TEST(Continuous, APlateauOnAStepIsAboveIt) {
    const VolumeGeometry geometry{.dims = {10, 5, 5}};
    const Texels texels =
        floatTexels(geometry, [](glm::ivec3 v) { return v.y == 2 && v.z == 2 ? 4.0 : 1.0; });
    ContinuousInput input =
        axisRay(texels, geometry,
                tfOf({{.value = 4.0, .opacity = 0.0}, {.value = 4.0, .opacity = 0.1}}), {});
    // Look along x exactly: no rotation that rounds.
    input.view.viewFromModel =
        glm::dmat4(glm::dvec4(0.0, 0.0, -1.0, 0.0), glm::dvec4(1.0, 0.0, 0.0, 0.0),
                   glm::dvec4(0.0, -1.0, 0.0, 0.0), glm::dvec4(-2.0, 2.0, -20.0, 1.0));
    expectSame(onlyPixel(input), layerOf(glm::dvec3(1.0), 0.1, 10.0), 1e-12);
    input.tf = tfOf({{.value = 4.0, .opacity = 0.1}, {.value = 4.0, .opacity = 0.0}});
    EXPECT_EQ(onlyPixel(input).w, 0.0);
}

TEST(Continuous, RaysThatMissTheBoxSeeNothing) {
    Dice dice(6);
    int missed = 0;
    for (int k = 0; k < 300; ++k) {
        Chance chance = chanceOf(dice, false);
        chance.input.texels = &chance.texels;
        chance.input.tf = tfOf({{.value = 0.0, .opacity = 0.9}});
        const glm::dvec2 at = test::randomFragCoord(dice, chance.scene);
        if (test::lengthInsideMm(chance.scene, at, 1e-6) == 0.0) {
            EXPECT_EQ(integrateRay(chance.input, at), glm::dvec4(0.0));
            ++missed;
        }
    }
    EXPECT_GT(missed, 50);
}

TEST(Continuous, TheSameRayFromAnyDistanceAndScale) {
    Dice dice(7);
    for (int k = 0; k < 40; ++k) {
        Chance chance = chanceOf(dice, k % 2 == 0);
        const OrbitCamera camera{dice.uniform(0.0, 360.0), dice.uniform(-90.0, 90.0), 2.0};
        const ContinuousInput input =
            axisRay(chance.texels, chance.input.geometry, chance.tf, camera);
        const glm::dvec4 expected = onlyPixel(input);
        ContinuousInput far = input;
        const BoundingSphere sphere = input.geometry.boundingSphere();
        far.view.viewFromModel =
            viewFromModel({camera.azimuthDegrees, camera.elevationDegrees, 1e6}, sphere);
        // The eye's place rounds to 2^-53 of a million radii: the ray is moved by so much, and a
        // grazed step by the root of it, which this seed does not meet.
        expectSame(onlyPixel(far), expected, 1e-7);
        for (const double scale : {1e-6, 1e6}) { // voxels of 1 nm and 1 km
            ContinuousInput scaled = input;
            scaled.geometry.spacingMm *= scale;
            scaled.geometry.originMm *= scale;
            scaled.tf.opacityUnitMm *= scale;
            scaled.view.viewFromModel = viewFromModel(camera, scaled.geometry.boundingSphere());
            expectSame(onlyPixel(scaled), expected, 1e-9);
        }
    }
}

TEST(Continuous, OpacityIsTheSameFromBehind) {
    Dice dice(8);
    for (int k = 0; k < 100; ++k) {
        const Chance chance = chanceOf(dice, k % 2 == 0);
        const OrbitCamera camera{dice.uniform(0.0, 360.0), dice.uniform(-80.0, 80.0), 2.0};
        const OrbitCamera behind{camera.azimuthDegrees + 180.0, -camera.elevationDegrees, 2.0};
        const double front =
            onlyPixel(axisRay(chance.texels, chance.input.geometry, chance.tf, camera)).w;
        const double back =
            onlyPixel(axisRay(chance.texels, chance.input.geometry, chance.tf, behind)).w;
        EXPECT_NEAR(front, back, 1e-9 * front) << k;
    }
}

TEST(Continuous, ValuesThatDifferInTheirLastBit) {
    const float low = 1e6F;
    const float high = std::nextafter(low, 2e6F);
    ObliqueRamp ramp;
    const auto pixelFor = [&](double first, double last) {
        ramp.texels =
            floatTexels(ramp.geometry, [&](glm::ivec3 v) { return v.z < 8 ? first : last; });
        return onlyPixel(axisRay(ramp.texels, ramp.geometry,
                                 tfOf({{.value = first, .color = kBlue, .opacity = 0.0},
                                       {.value = last, .color = kOrange, .opacity = 0.5}}),
                                 ramp.camera));
    };
    expectSame(pixelFor(low, high), pixelFor(0.0, 1.0), 1e-10);
    expectSame(pixelFor(0.0, 0x1p-149), pixelFor(0.0, 1.0), 1e-10); // denormal in float32
}

// ---- agreement

TEST(Continuous, AgreesWithItselfAtAHundredthOfTheTolerance) {
    Dice dice(9);
    double largest = 0.0;
    int lit = 0;
    for (int k = 0; k < 400; ++k) {
        Chance chance = chanceOf(dice, k % 2 == 0);
        chance.input.texels = &chance.texels;
        if (k % 4 == 0) {
            chance.input.tf.opacityUnitMm *= 1e-7; // stiff
        }
        const glm::dvec2 at = test::randomFragCoord(dice, chance.scene);
        for (const double tolerance : {1e-4, 1e-8, 1e-10}) {
            chance.input.tolerance = tolerance;
            const glm::dvec4 coarse = integrateRay(chance.input, at);
            chance.input.tolerance = 0.01 * tolerance;
            const glm::dvec4 fine = integrateRay(chance.input, at);
            expectSame(coarse, fine, tolerance);
            largest = std::max(largest, std::abs(coarse.w - fine.w));
            lit += fine.w > 0.0;
        }
    }
    EXPECT_GT(largest, 0.0);
    EXPECT_GT(lit, 500);
}

/// Plain midpoint quadrature in even steps of uvw, from the matrices alone.
class Quadrature {
public:
    Quadrature(const Chance& chance, glm::dvec2 fragCoord) : chance_(chance) {
        const FrameScene& scene = chance.scene;
        const glm::dmat4 modelFromView = glm::inverse(scene.view.viewFromModel);
        const glm::dmat4 uvwFromView = scene.geometry.uvwFromModel() * modelFromView;
        const glm::dvec4 perDepth(scene.tangentAt(fragCoord), -1.0, 0.0);
        eye_ = glm::dvec3(uvwFromView[3]);
        perDepth_ = glm::dvec3(uvwFromView * perDepth);
        begin_ = scene.view.nearDepth;
        end_ = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const double a = -eye_[k] / perDepth_[k];
            const double b = (1.0 - eye_[k]) / perDepth_[k];
            begin_ = std::max(begin_, std::min(a, b));
            end_ = std::min(end_, std::max(a, b));
        }
        mmPerDepth_ = glm::length(glm::dvec3(modelFromView * perDepth));
    }

    bool hits() const { return begin_ < end_; }

    glm::dvec4 sum(int samples) {
        const double step = (end_ - begin_) / samples;
        const double stepMm = step * mmPerDepth_;
        double depth = 0.0;
        glm::dvec3 color(0.0);
        for (int i = 0; i < samples; ++i) {
            const TransferSample material =
                evaluate(chance_.tf, valueAt(eye_ + (begin_ + (i + 0.5) * step) * perDepth_));
            const double extinction = -std::log1p(-material.opacity) / chance_.tf.opacityUnitMm;
            const double opticalDepth = extinction * stepMm;
            const glm::dvec3 emitted = chance_.input.space == CompositingSpace::Linear
                                           ? linearFromSrgb(material.color)
                                           : material.color;
            color += emitted * (-std::exp(-depth) * std::expm1(-opticalDepth));
            note({emitted * (opticalDepth * std::exp(-depth)), opticalDepth});
            depth += opticalDepth;
        }
        return {color, -std::expm1(-depth)};
    }

    /// A midpoint rule of step h errs by h d / 2 at a jump of d and by h^2 k / 8 at most where the
    /// slope changes by k; the second differences sum up to 2 d and h k there. So a quarter of
    /// their sum bounds the errors of a channel and of the optical depth that attenuates it.
    double bound() const {
        const glm::dvec4& sums = differences_;
        return 0.25 * (sums.w + std::max({sums.x, sums.y, sums.z}));
    }

private:
    double valueAt(glm::dvec3 uvw) const {
        const glm::ivec3 dims = chance_.texels.dims;
        const auto* voxels = reinterpret_cast<const float*>(chance_.texels.data.data());
        const glm::dvec3 place = uvw * glm::dvec3(dims) - 0.5;
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1.0;
            std::int64_t index = 0;
            for (int axis = 2; axis >= 0; --axis) {
                const double low = std::floor(place[axis]);
                const bool high = ((corner >> axis) & 1) != 0;
                const double share = place[axis] - low;
                weight *= high ? share : 1.0 - share;
                const int voxel =
                    std::clamp(static_cast<int>(low) + (high ? 1 : 0), 0, dims[axis] - 1);
                index = index * dims[axis] + voxel;
            }
            sum += weight * (chance_.texels.valueScale * voxels[index] + chance_.texels.valueBias);
        }
        return sum;
    }

    void note(glm::dvec4 value) {
        if (noted_++ >= 2) {
            differences_ += glm::abs(value - 2.0 * last_ + before_);
        }
        before_ = last_;
        last_ = value;
    }

    const Chance& chance_;
    glm::dvec3 eye_;
    glm::dvec3 perDepth_;
    double begin_ = 0.0;
    double end_ = 0.0;
    double mmPerDepth_ = 0.0;
    glm::dvec4 before_{0.0}; // emission of the last samples, and their optical depth
    glm::dvec4 last_{0.0};
    int noted_ = 0;
    glm::dvec4 differences_{0.0};
};

/// Random rays that meet something, against quadrature with so many samples.
void compareWithQuadrature(std::uint64_t seed, bool steps, int rays, int samples) {
    Dice dice(seed);
    for (int compared = 0; compared < rays;) {
        Chance chance = chanceOf(dice, steps);
        chance.input.texels = &chance.texels;
        const glm::dvec2 at = test::randomFragCoord(dice, chance.scene);
        // From far away the quadrature's own eye is rounded, not the reference's.
        const double distance = glm::length(
            glm::dvec3(chance.scene.view.viewFromModel *
                       glm::dvec4(chance.scene.geometry.boundingSphere().centreMm, 1.0)));
        const double radius = chance.scene.frame().radius;
        Quadrature quadrature(chance, at);
        const glm::dvec4 pixel = integrateRay(chance.input, at);
        if (!quadrature.hits() || pixel.w == 0.0 || distance > 10.0 * radius) {
            continue;
        }
        const glm::dvec4 expected = quadrature.sum(samples);
        const double bound = quadrature.bound() + 1e-10;
        EXPECT_LT(bound, steps ? 1e-2 : 1e-6);
        for (int channel = 0; channel < 4; ++channel) {
            EXPECT_NEAR(pixel[channel], expected[channel], bound)
                << "ray " << compared << ", channel " << channel;
        }
        ++compared;
    }
}

TEST(Continuous, AgreesWithPlainQuadratureOnSmoothTransferFunctions) {
    compareWithQuadrature(10, false, 60, 50'000);
}

TEST(Continuous, AgreesWithPlainQuadratureOnSteps) {
    compareWithQuadrature(11, true, 60, 50'000);
}

TEST(Continuous, AgreesWithAMillionSamples) {
    compareWithQuadrature(12, false, 3, 1'000'000);
    compareWithQuadrature(13, true, 3, 1'000'000);
}

// ---- the picture

TEST(Continuous, APictureIsItsRays) {
    const Shells shells;
    const TransferFunction tf = tfOf({{.value = 20.0, .color = kBlue, .opacity = 0.0},
                                      {.value = 60.0, .color = kOrange, .opacity = 0.3}});
    ContinuousInput input = axisRay(shells.texels, shells.geometry, tf, shells.camera);
    input.viewport = {7, 3, 33, 21};
    std::vector<double> shares;
    std::atomic<int> inside{0};
    const std::vector<glm::dvec4> pixels = renderContinuous(input, [&](double share) {
        EXPECT_EQ(inside.fetch_add(1), 0);
        shares.push_back(share);
        --inside;
    });
    ASSERT_EQ(pixels.size(), 33U * 21U);
    int lit = 0;
    for (int y = 0; y < 21; ++y) {
        for (int x = 0; x < 33; ++x) {
            const glm::dvec4 pixel = pixels[static_cast<std::size_t>(y * 33 + x)];
            EXPECT_EQ(pixel, integrateRay(input, glm::dvec2(7 + x, 3 + y) + 0.5));
            lit += pixel.w > 0.0;
        }
    }
    EXPECT_GT(lit, 100);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    ASSERT_FALSE(shares.empty());
    EXPECT_GT(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 1.0);
}

TEST(Continuous, CancelsToAnEmptyPicture) {
    const ObliqueRamp ramp;
    ContinuousInput input =
        axisRay(ramp.texels, ramp.geometry, tfOf({{.value = 0.0, .opacity = 0.1}}), {});
    input.viewport = {0, 0, 64, 64};
    CancelToken cancel{false};
    int reports = 0;
    const auto stop = [&](double) {
        ++reports;
        cancel = true;
    };
    EXPECT_TRUE(renderContinuous(input, stop, &cancel).empty());
    EXPECT_GE(reports, 1);
    EXPECT_LT(reports, 32);
}

TEST(Continuous, EveryTexelFormatHoldsTheSameField) {
    const VolumeGeometry geometry{.dims = {5, 7, 6}, .direction = Dice(3).rotation()};
    const auto value = [](glm::ivec3 v) { return (v.x * 53 + v.y * 31 + v.z * 97) % 256; };
    const Volume volume = test::volumeOf<std::uint8_t>(geometry, VoxelType::U8, value);
    const TransferFunction tf = tfOf({{.value = 100.0, .color = kBlue, .opacity = 0.0},
                                      {.value = 200.0, .color = kOrange, .opacity = 0.6}});
    const Texels reference = floatTexels(geometry, value);
    const glm::dvec4 expected = onlyPixel(axisRay(reference, geometry, tf, {}));
    EXPECT_GT(expected.w, 0.1);
    for (const TexelFormat format : {TexelFormat::R8, TexelFormat::R16, TexelFormat::R16F,
                                     TexelFormat::Rg8Exact, TexelFormat::R32fExact}) {
        const Texels texels = encodeTexels(volume, computeStatistics(volume), format);
        expectSame(onlyPixel(axisRay(texels, geometry, tf, {})), expected, 1e-10);
    }
}

} // namespace
} // namespace slabcast

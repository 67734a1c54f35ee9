#include "core/view/lattice.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using test::FrameScene;

using Real = long double;
using RealVec3 = glm::vec<3, Real>;
using RealVec4 = glm::vec<4, Real>;
using RealMat4 = glm::mat<4, 4, Real>;

/// Where layer `index` is sampled along a pixel's ray, in mm of patient space: built in view space,
/// in extended precision, by intersecting the ray with the layer's plane or shell.
RealVec3 sampleByIntersection(const FrameScene& scene, glm::dvec2 fragCoord, int index) {
    const RealMat4 viewFromModel(scene.view.viewFromModel);
    const RealVec3 centre(viewFromModel *
                          RealVec4(RealVec3(scene.geometry.boundingSphere().centreMm), 1.0L));
    const Real viewUnitsPerMm = glm::length(RealVec3(viewFromModel[0]));
    const glm::ivec2 corner(scene.viewport.x, scene.viewport.y);
    const double jitter =
        scene.lattice.jittered ? jitterOf(glm::ivec2(glm::floor(fragCoord)) - corner) : 0.0;
    const Real offset = (index + 0.5L - scene.lattice.total / 2.0L + jitter) *
                        scene.lattice.spacingMm * viewUnitsPerMm;
    const RealVec3 perDepth(RealVec3(glm::dvec3(scene.tangentAt(fragCoord), -1.0)));
    const RealVec3 place = scene.lattice.kind == LatticeKind::Planar
                               ? perDepth * (offset - centre.z)
                               : glm::normalize(perDepth) * (offset + glm::length(centre));
    return RealVec3(glm::inverse(viewFromModel) * RealVec4(place, 1.0L));
}

RealVec3 modelOf(const FrameScene& scene, glm::dvec3 uvw) {
    return RealVec3(RealMat4(scene.geometry.modelFromUvw()) * RealVec4(RealVec3(uvw), 1.0L));
}

/// Random scenes and pixels whose rays meet layers.
template <class Visit>
void forRays(std::uint64_t seed, Visit visit) {
    Dice dice(seed);
    int rays = 0;
    for (int k = 0; k < 3000; ++k) {
        const FrameScene scene = test::randomScene(dice, 1 + dice.below(500));
        const RayFrame frame = scene.frame();
        for (int pixel = 0; pixel < 5; ++pixel) {
            const glm::dvec2 at = test::randomFragCoord(dice, scene);
            const LatticeRay ray = rayAt(frame, at);
            const LayerRange met = layersOf(ray, scene.lattice.total);
            rays += met.begin < met.end;
            visit(scene, at, ray, met);
        }
    }
    EXPECT_GT(rays, 5000);
}

TEST(Lattice, SamplesLieWhereTheMatricesSay) {
    forRays(1, [&](const FrameScene& scene, glm::dvec2 at, const LatticeRay& ray, LayerRange met) {
        const double radius = scene.geometry.boundingSphere().radiusMm;
        const int total = scene.lattice.total;
        for (int layer = met.begin; layer < met.end; layer += 1 + (met.end - met.begin) / 5) {
            const RealVec3 sample = modelOf(scene, samplePosition(ray, total, layer));
            const Real off = glm::distance(sample, sampleByIntersection(scene, at, layer));
            EXPECT_LT(off, 1e-9 * radius) << "total " << total << ", layer " << layer;
            const Real step =
                glm::distance(sample, modelOf(scene, samplePosition(ray, total, layer + 1)));
            EXPECT_NEAR(static_cast<double>(step), ray.layerLengthMm, 1e-9 * radius);
        }
    });
}

TEST(Lattice, LayersAddUpToTheLengthInside) {
    forRays(2, [](const FrameScene& scene, glm::dvec2 at, const LatticeRay& ray, LayerRange) {
        double sumMm = 0.0;
        for (int layer = 0; layer < scene.lattice.total; ++layer) {
            sumMm += layerWeight(ray, scene.lattice.total, layer) * ray.layerLengthMm;
        }
        // Bounds instead of a tolerance: a ray that grazes a face may gain or lose all of its
        // length by rounding.
        const double slack = 1e-9 * scene.geometry.boundingSphere().radiusMm;
        EXPECT_GE(sumMm, test::lengthInsideMm(scene, at, -slack) - slack);
        EXPECT_LE(sumMm, test::lengthInsideMm(scene, at, slack) + slack);
    });
}

TEST(Lattice, LayersMetAreThoseWithLength) {
    Dice dice(3);
    for (int k = 0; k < 20000; ++k) {
        const int total = 1 + dice.below(12);
        // Multiples of a quarter: ends between layers and on their borders, even and odd totals.
        const double entry = (dice.below(64) - 32) / 4.0;
        const double exit = entry + (dice.below(24) - 4) / 4.0;
        const LatticeRay ray{.layerLengthMm = 1.0, .entry = entry, .exit = exit};
        const LayerRange met = layersOf(ray, total);
        for (int layer = 0; layer < total; ++layer) {
            const double low = layer - total / 2.0;
            const double inside = std::max(0.0, std::min(exit, low + 1.0) - std::max(entry, low));
            EXPECT_EQ(layerWeight(ray, total, layer), inside);
            EXPECT_EQ(layer >= met.begin && layer<met.end, inside> 0.0)
                << entry << " " << exit << " " << total;
        }
    }
}

TEST(Lattice, ARayWithoutEndsMeetsEverythingOrNothing) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const LayerRange all = layersOf({.entry = -kInfinity, .exit = kInfinity}, 5);
    EXPECT_EQ(all.begin, 0);
    EXPECT_EQ(all.end, 5);
    const LayerRange none = layersOf({.entry = 1.0, .exit = -1.0}, 5);
    EXPECT_EQ(none.begin, none.end);
    const LayerRange unordered = layersOf({.entry = std::nan(""), .exit = 1.0}, 5);
    EXPECT_EQ(unordered.begin, unordered.end);
}

TEST(Lattice, CoversTheSphereWithTheFewestLayers) {
    EXPECT_EQ(layersToCover(222.0, 1.0), 444);
    EXPECT_EQ(layersToCover(222.0 * 0.1, 0.1), 444); // not 445 by rounding
    EXPECT_EQ(layersToCover(222.01, 1.0), 445);
    EXPECT_EQ(layersToCover(1.0, 2.0), 1);
    EXPECT_EQ(layersToCover(1.0, 1e9), 1);
    EXPECT_EQ(layersToCover(0.0, 1.0), 1);
    EXPECT_EQ(layersToCover(1.0, 1e-9), 1 << 22);
    EXPECT_EQ(layersToCover(1e300, 1e-300), 1 << 22);
    Dice dice(4);
    for (int k = 0; k < 1000; ++k) {
        const double radius = dice.logUniform(1.0, 300.0);
        const double spacing = dice.logUniform(0.1, 10.0);
        const int layers = layersToCover(radius, spacing);
        EXPECT_GE(layers * spacing, 2.0 * radius * (1.0 - 1e-11));
        EXPECT_LT((layers - 1) * spacing, 2.0 * radius);
    }
}

// What interleaved gradient noise is for: evenly spread over the layer, and so already among any
// few neighbours.
TEST(Lattice, JitterSpreadsNeighboursEvenlyOverTheLayer) {
    std::array<int, 16> bins{};
    double worstMean = 0.0;
    double leastSpread = 1.0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const double offset = jitterOf({x, y});
            ASSERT_GE(offset, -0.5);
            ASSERT_LT(offset, 0.5);
            ++bins[static_cast<std::size_t>((offset + 0.5) * 16.0)];
            double sum = 0.0, low = 1.0, high = -1.0;
            for (int k = 0; k < 9; ++k) {
                const double near = jitterOf({x + k % 3, y + k / 3});
                sum += near / 9.0;
                low = std::min(low, near);
                high = std::max(high, near);
            }
            worstMean = std::max(worstMean, std::abs(sum));
            leastSpread = std::min(leastSpread, high - low);
        }
    }
    for (const int count : bins) {
        EXPECT_NEAR(count, 256 * 256 / 16, 256 * 256 / 16 / 20);
    }
    // Nine places a ninth apart: their mean is off by at most half of that, and by as much again
    // since rows advance by 0.309 and not by a third, which moves the third row by 0.048 of the
    // 0.056 that half a place is. White noise has means of 0.3 and spreads of 0.4.
    EXPECT_LT(worstMean, 1.0 / 9.0);
    EXPECT_GT(leastSpread, 8.0 / 9.0 - 1.0 / 9.0);
}

TEST(Lattice, TheViewportsPlaceMovesNothing) {
    Dice dice(5);
    for (int k = 0; k < 200; ++k) {
        FrameScene scene = test::randomScene(dice, 50);
        const glm::dvec2 place(scene.viewport.x, scene.viewport.y);
        const glm::dvec2 at = glm::floor(test::randomFragCoord(dice, scene) - place) + 0.5;
        const LatticeRay there = rayAt(scene.frame(), at + place);
        scene.viewport.x = 0;
        scene.viewport.y = 0;
        const LatticeRay here = rayAt(scene.frame(), at);
        EXPECT_EQ(there.centre, here.centre);
        EXPECT_EQ(there.step, here.step);
        EXPECT_EQ(there.layerLengthMm, here.layerLengthMm);
    }
}

TEST(Lattice, OnTheAxisItIsWhatOneDraws) {
    // A cube of 10 mm, 30 mm before the eye, four layers of 5 mm: sampled 22.5, 27.5, 32.5 and 37.5
    // mm away.
    FrameScene scene;
    scene.geometry = {.dims = glm::ivec3(10), .originMm = glm::dvec3(-4.5)};
    scene.view.viewFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, -30.0});
    scene.viewport = {4, 6, 10, 10};
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        scene.lattice = {kind, 4, 5.0};
        const LatticeRay ray = rayAt(scene.frame(), {9.0, 11.0});
        for (int layer = 0; layer < 4; ++layer) {
            const double z = -22.5 - 5.0 * layer + 30.0; // of the model
            const glm::dvec3 expected(0.5, 0.5, (z + 5.0) / 10.0);
            EXPECT_NEAR(glm::distance(samplePosition(ray, 4, layer), expected), 0.0, 1e-14)
                << name(kind);
        }
        EXPECT_NEAR(ray.layerLengthMm, 5.0, 1e-14);
        EXPECT_NEAR(ray.entry, -1.0, 1e-14);
        EXPECT_NEAR(ray.exit, 1.0, 1e-14);
    }
}

TEST(Lattice, ObliqueLayersAreLongerUnlessTheyAreShells) {
    FrameScene scene;
    scene.geometry = {.dims = glm::ivec3(10), .originMm = glm::dvec3(-4.5)};
    scene.view.viewFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, -30.0});
    scene.view.frustum = {-0.75, 0.75, -0.75, 0.75};
    scene.viewport = {0, 0, 10, 10};
    scene.lattice = {LatticeKind::Planar, 4, 5.0};
    EXPECT_NEAR(rayAt(scene.frame(), {10.0, 5.0}).layerLengthMm, 5.0 * 1.25, 1e-14); // 3, 4, 5
    scene.lattice.kind = LatticeKind::Shells;
    EXPECT_NEAR(rayAt(scene.frame(), {10.0, 5.0}).layerLengthMm, 5.0, 1e-14);
}

} // namespace
} // namespace slabcast

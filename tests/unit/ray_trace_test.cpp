#include "core/reference/ray_trace.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/reference/continuous.h"
#include "core/reference/discrete.h"
#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;

constexpr Viewport kViewport{3, 2, 6, 5};

struct Traced {
    Texels texels;
    TraceInput input;
    glm::dvec2 fragCoord;
};

/// A volume of noise, anywhere in space and however sheared, seen from outside or within.
Traced tracedOf(Dice& dice) {
    Traced t;
    VolumeGeometry geometry = test::randomGeometry(dice);
    geometry.dims = glm::ivec3(2 + dice.below(8), 2 + dice.below(8), 2 + dice.below(8));
    t.texels = test::floatTexels(geometry, [&](glm::ivec3) { return dice.uniform(0.0, 9.0); });
    const BoundingSphere sphere = geometry.boundingSphere();
    const OrbitCamera camera{dice.uniform(0.0, 360.0), dice.uniform(-80.0, 80.0),
                             dice.uniform(0.3, 3.0)};
    t.input = {.geometry = geometry,
               .tf = test::tfOf({{.value = 2.0, .color = {1.0, 0.2, 0.0}, .opacity = 0.0},
                                 {.value = 6.0, .color = {0.3, 0.9, 0.4}, .opacity = 0.3}},
                                sphere.radiusMm),
               .view = {viewFromModel(camera, sphere), symmetricFrustum(40.0, 1.2), 0.0},
               .viewport = kViewport,
               .lattice = {.kind = dice.chance(0.5) ? LatticeKind::Planar : LatticeKind::Shells,
                           .total = 200,
                           .spacingMm = 8.0 * sphere.radiusMm / 200.0,
                           .jittered = dice.chance(0.3)}};
    t.fragCoord = {kViewport.x + dice.below(kViewport.width) + 0.5,
                   kViewport.y + dice.below(kViewport.height) + 0.5};
    return t;
}

/// The two pictures that the report compares, at one pixel.
TEST(RayTrace, EndsWhereBothReferencesDo) {
    Dice dice(1);
    int met = 0;
    for (int k = 0; k < 30; ++k) {
        Traced t = tracedOf(dice);
        t.input.texels = &t.texels;
        t.input.space = k % 2 == 0 ? CompositingSpace::Display : CompositingSpace::Linear;
        const glm::dvec2 at = t.fragCoord;
        const RayTrace trace = traceRay(t.input, at);
        if (trace.layers.empty()) {
            continue;
        }
        ++met;
        const DiscreteInput sampled{.texels = &t.texels,
                                    .geometry = t.input.geometry,
                                    .transfer = t.input.tf,
                                    .space = t.input.space,
                                    .view = t.input.view,
                                    .viewport = kViewport,
                                    .lattice = t.input.lattice};
        const auto index = static_cast<std::size_t>((at.y - kViewport.y - 0.5) * kViewport.width +
                                                    (at.x - kViewport.x - 0.5));
        const glm::dvec4 expected = renderDiscrete(sampled)[index];
        const glm::dvec4 exact = integrateRay({.texels = &t.texels,
                                               .geometry = t.input.geometry,
                                               .tf = t.input.tf,
                                               .space = t.input.space,
                                               .view = t.input.view,
                                               .viewport = kViewport},
                                              at);
        for (int c = 0; c < 4; ++c) {
            EXPECT_NEAR(trace.layers.back().gathered[c], expected[c], 1e-14);
            EXPECT_NEAR(trace.layers.back().exact[c], exact[c], 1e-9);
        }
    }
    EXPECT_GT(met, 10);
}

TEST(RayTrace, LayersTileTheStretchBetweenEntryAndExit) {
    Dice dice(2);
    int met = 0;
    for (int k = 0; k < 30; ++k) {
        Traced t = tracedOf(dice);
        t.input.texels = &t.texels;
        const RayTrace trace = traceRay(t.input, t.fragCoord);
        if (trace.layers.empty()) {
            continue;
        }
        ++met;
        double lengthMm = 0.0;
        const double radiusMm = t.input.geometry.boundingSphere().radiusMm;
        for (const TracedLayer& layer : trace.layers) {
            lengthMm += layer.lengthMm;
            const glm::dvec3 along = trace.eyeMm + layer.distanceMm * trace.direction;
            const double reach = radiusMm + glm::length(trace.eyeMm);
            EXPECT_LT(glm::distance(along, layer.placeMm), 1e-9 * reach);
            EXPECT_NEAR(
                layer.alpha,
                1.0 - std::pow(1.0 - layer.opacity, layer.lengthMm / t.input.tf.opacityUnitMm),
                1e-12);
        }
        EXPECT_NEAR(lengthMm, trace.exitMm - trace.entryMm, 1e-6 * radiusMm);
    }
    EXPECT_GT(met, 10);
}

} // namespace
} // namespace slabcast

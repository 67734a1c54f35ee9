#include "core/reference/formula_ray.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/formula_volume.h"

namespace slabcast {
namespace {

using test::tfOf;

/// Along x through a box of 10 mm, in so many layers over 16 mm: the box's ends cut layers.
LatticeRay rayOf(int total) {
    const double perLayer = 1.6 / total; // of the box
    return {.centre = glm::dvec3(0.53, 0.5, 0.5),
            .step = {perLayer, 0.0, 0.0},
            .layerLengthMm = 16.0 / total,
            .entry = -0.53 / perLayer,
            .exit = 0.47 / perLayer};
}

/// Opacity rises along the ray, colour with it: u = rise x.
FormulaInput rampInput() {
    return {[](glm::dvec3 uvw) { return uvw.x; },
            tfOf({{.value = -1.0, .color = {0.0, 0.2, 1.0}, .opacity = 0.1},
                  {.value = 2.0, .color = {0.9, 0.2, 0.1}, .opacity = 0.7}},
                 5.0)};
}

TEST(FormulaRay, TheIntegralOfARampIsClosed) {
    const double first = 0.1 + 0.2, rise = 0.2; // opacity at the near face, and its rise in the box
    const auto antiderivative = [](double u) { return (1.0 - u) * std::log1p(-u) + u; };
    const double depth = (antiderivative(first + rise) - antiderivative(first)) / rise * 10.0 / 5.0;
    const glm::dvec4 pixel = integrateFormula(rampInput(), rayOf(1), 4);
    EXPECT_NEAR(pixel.w, -std::expm1(-depth), 1e-13);
    EXPECT_NEAR(pixel.y, 0.2 * pixel.w, 1e-13); // green is the same everywhere
}

/// A density that waves: depth is the mean density and what is left of the wave. One colour.
TEST(FormulaRay, TheIntegralOfAWaveIsClosed) {
    // Extinction is -ln(1 - u) / 5 with u = 1 - exp(-(1 + sin(4 pi x))): (1 + sin 4 pi x) / 5.
    FormulaInput input{
        [](glm::dvec3 uvw) { return -std::expm1(-(1.0 + std::sin(4.0 * M_PI * uvw.x))); },
        tfOf({{.value = 0.0, .color = glm::dvec3(0.5), .opacity = 0.0},
              {.value = 1.0, .color = glm::dvec3(0.5), .opacity = 1.0}},
             5.0)};
    const glm::dvec4 pixel = integrateFormula(input, rayOf(1), 8);
    EXPECT_NEAR(pixel.w, -std::expm1(-10.0 / 5.0), 1e-7); // TF opacity ends at 1 - 2^-24
    EXPECT_NEAR(pixel.x, 0.5 * pixel.w, 1e-12);
    const glm::dvec4 finer = integrateFormula(input, rayOf(1), 16);
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(pixel[k], finer[k], 1e-12);
    }
}

TEST(FormulaRay, RaysThatMissSeeNothing) {
    LatticeRay ray = rayOf(8);
    ray.entry = ray.exit;
    EXPECT_EQ(integrateFormula(rampInput(), ray, 4), glm::dvec4(0.0));
    EXPECT_EQ(sampleFormula(rampInput(), ray, 8, RayRule{}), glm::dvec4(0.0));
}

/// Mean square error of rays at a few offsets: the ends cut layers differently.
double errorOf(const RayRule& rule, int total) {
    const FormulaInput input = rampInput();
    double squares = 0.0;
    for (int k = 0; k < 8; ++k) {
        LatticeRay ray = rayOf(total);
        const double shift = k / 8.0;
        ray.centre -= shift * ray.step;
        ray.entry += shift;
        ray.exit += shift;
        const glm::dvec4 apart =
            sampleFormula(input, ray, total, rule) - integrateFormula(input, ray, 4);
        squares += glm::dot(apart, apart);
    }
    return std::sqrt(squares / 8.0);
}

/// Each rule has the order that its mistake leaves it, and no mistake the right one's.
TEST(FormulaRay, RulesHaveTheOrdersThatTheyClaim) {
    for (const RayRule& rule : rayRules()) {
        const double order = std::log2(errorOf(rule, 128) / errorOf(rule, 256));
        EXPECT_NEAR(order, rule.order, 0.1) << rule.name;
    }
    EXPECT_FALSE(rayRules().front().isControl());
    for (std::size_t k = 1; k < rayRules().size(); ++k) {
        EXPECT_TRUE(rayRules()[k].isControl()) << rayRules()[k].name;
    }
}

} // namespace
} // namespace slabcast

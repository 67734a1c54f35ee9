#include "perf/stability/manufactured_solution.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace slabcast::stability::manufactured {
namespace {

/// Simpson's rule, of order 4.
template <class F>
auto integral(int parts, double end, const F& f) {
    auto sum = f(0.0) * 0.0;
    const double h = end / parts;
    for (int i = 0; i < parts; ++i) {
        sum += (f(i * h) + 4.0 * f((i + 0.5) * h) + f((i + 1.0) * h)) * (h / 6.0);
    }
    return sum;
}

TEST(ManufacturedSolution, LetsThroughWhatItsExtinctionLeaves) {
    for (const double s : {0.0, 0.2, 0.5, 0.77, 1.0}) {
        const double depth = integral(1, s, extinction); // exact: a quadratic
        EXPECT_NEAR(transmittance(s), std::exp(-depth), 1e-15) << s;
    }
    EXPECT_NEAR(integral(1, 1.0, extinction), kDepth, 1e-14);
}

TEST(ManufacturedSolution, IsTheIntegralOfWhatTheMediumEmits) {
    for (const double lean : {1.0, 1.25}) {
        const glm::dvec4 gathered = integral(2000, 1.0, [&](double s) {
            const double w = lean * extinction(s) * std::pow(transmittance(s), lean);
            return w * glm::dvec4(color(s), 1.0);
        });
        const glm::dvec4 meant = solution(lean);
        for (int k = 0; k < 4; ++k) {
            EXPECT_NEAR(meant[k], gathered[k], 1e-11) << k << " at a lean of " << lean;
        }
    }
}

TEST(ManufacturedSolution, IsWhatItsTransferFunctionIsMadeOf) {
    const TransferFunction tf = transferFunction(64);
    for (int k = 0; k <= 64; ++k) {
        const double s = k / 64.0;
        const TransferSample sample = evaluate(tf, kLastValue * s);
        EXPECT_NEAR(extinctionPerMm(sample.opacity, tf.opacityUnitMm) * kThicknessMm, extinction(s),
                    1e-12);
        EXPECT_NEAR(glm::length(sample.color - color(s)), 0.0, 1e-15);
    }
}

/// The greatest of derivatives, which bounds are made from, against differences.
TEST(ManufacturedSolution, ChangesNoFasterThanItsRate) {
    constexpr double kStep = 1e-5;
    for (double s = kStep; s < 1.0 - kStep; s += 0.01) {
        const glm::dvec3 slope = (color(s + kStep) - color(s - kStep)) / (2.0 * kStep);
        EXPECT_LE(std::max({std::abs(slope.x), std::abs(slope.y), std::abs(slope.z)}), kRate);
        EXPECT_LE(extinction(s), kMostExtinction);
    }
}

} // namespace
} // namespace slabcast::stability::manufactured

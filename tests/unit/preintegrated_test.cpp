#include "core/transfer/preintegrated.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/transfer/transfer_integral.h"
#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using test::tfOf;

constexpr auto kDisplay = CompositingSpace::Display;
constexpr auto kLinear = CompositingSpace::Linear;
constexpr double kHalfUnit = 0x1p-11; // relative, of fp16

/// Points anywhere in [0, highest], a third of them steps, some invisible.
TransferFunction randomTf(Dice& dice, double highest) {
    std::vector<double> values;
    for (int k = 0; k < 2 + dice.below(5); ++k) {
        values.push_back(dice.uniform(0.0, highest));
        if (dice.chance(0.3)) {
            values.push_back(values.back());
        }
    }
    std::sort(values.begin(), values.end());
    std::vector<TransferPoint> points;
    for (const double value : values) {
        const double opacity = dice.chance(0.4) ? 0.0 : dice.uniform(0.0, 1.0);
        points.push_back({value, dice.inCube(0.0, 1.0), opacity});
    }
    return tfOf(std::move(points), dice.logUniform(1e-3, 1e3));
}

/// Integral of -ln(1 - u): (1 - u) ln(1 - u) + u, whose digits a series keeps where u is small.
double depthIntegral(double u) {
    return u < 1e-3 ? u * u * (1.0 / 2.0 + u * (1.0 / 6.0 + u * (1.0 / 12.0 + u / 20.0)))
                    : (1.0 - u) * std::log1p(-u) + u;
}

/// Whether any value strictly between is visible: at the low end what holds from there on counts,
/// at the high end what holds up to there, which of a step is its first point.
bool visibleBetween(const TransferFunction& tf, double low, double high) {
    bool visible = evaluate(tf, low).opacity > 0.0;
    bool stepsAtHigh = false;
    for (std::size_t k = 0; k < tf.points.size(); ++k) {
        const TransferPoint& point = tf.points[k];
        const bool second = k > 0 && tf.points[k - 1].value == point.value;
        stepsAtHigh |= second && point.value == high;
        visible |= point.opacity > 0.0 && point.value > low &&
                   (point.value < high || (point.value == high && !second));
    }
    return visible || (!stepsAtHigh && evaluate(tf, high).opacity > 0.0);
}

TEST(TransferIntegral, IsTheClosedFormOfLinearOpacity) {
    for (const double most : {1e-12, 1e-4, 0.3, 0.999, kMaxOpacity}) {
        const TransferFunction tf =
            tfOf({{.value = -3.0, .opacity = 0.0}, {.value = 7.0, .opacity = most}}, 2.0);
        const TransferIntegral integral(tf, kDisplay);
        Dice dice(1);
        for (int k = 0; k < 100; ++k) {
            const double a = dice.uniform(0.0, most);
            const double b = dice.chance(0.2) ? most : dice.uniform(0.0, most);
            const double mean = (depthIntegral(b) - depthIntegral(a)) / (b - a) / 2.0;
            const double got = integral.mean(-3.0 + 10.0 * a / most, -3.0 + 10.0 * b / most).w;
            // The difference of the closed form itself loses digits.
            EXPECT_NEAR(got, mean, mean * 1e-10 + most * 1e-13 / std::abs(b - a)) << most;
        }
    }
}

TEST(TransferIntegral, WeighsColoursByExtinction) {
    // Colour a + b w over w = 1 - opacity: integrals of -ln w and -w ln w.
    const double least = 0.02;
    const TransferFunction tf =
        tfOf({{.value = 0.0, .color = {0.9, 0.5, 0.0}, .opacity = 0.0},
              {.value = 1.0, .color = {0.1, 0.5, 1.0}, .opacity = 1.0 - least}});
    const auto first = [](double w) { return w - w * std::log(w); };
    const auto second = [](double w) { return w * w / 4.0 - w * w / 2.0 * std::log(w); };
    const double depth = (first(1.0) - first(least)) / (1.0 - least);
    const double moment = (second(1.0) - second(least)) / (1.0 - least);
    const double slope = 0.8 / (1.0 - least); // of red, falling as w does
    const glm::dvec4 mean = TransferIntegral(tf, kDisplay).mean(0.0, 1.0);
    EXPECT_NEAR(mean.x, (0.9 - slope) * depth + slope * moment, 1e-12);
    EXPECT_NEAR(mean.y, 0.5 * depth, 1e-12);
    EXPECT_NEAR(mean.z, (1.0 / (1.0 - least)) * (depth - moment), 1e-12);
    EXPECT_NEAR(mean.w, depth, 1e-12);
}

TEST(TransferIntegral, TakesLinearLightAsAFineSumDoes) {
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 1.0, 0.04}, .opacity = 0.9},
                                      {.value = 1.0, .color = {1.0, 0.3, 0.05}, .opacity = 0.2}});
    glm::dvec4 sum(0.0);
    constexpr int kSteps = 1 << 15; // the midpoint rule: off by 1/24 of the curve times 2^-30
    for (int k = 0; k < kSteps; ++k) {
        const TransferSample sample = evaluate(tf, (k + 0.5) / kSteps);
        sum += extinctionPerMm(sample.opacity, 1.0) * glm::dvec4(linearFromSrgb(sample.color), 1.0);
    }
    const glm::dvec4 mean = TransferIntegral(tf, kLinear).mean(1.0, 0.0);
    for (int channel = 0; channel < 4; ++channel) {
        EXPECT_NEAR(mean[channel], sum[channel] / kSteps, 1e-8) << channel;
    }
}

TEST(TransferIntegral, IsAdditiveAndSymmetric) {
    Dice dice(2);
    for (int k = 0; k < 300; ++k) {
        const CompositingSpace space = dice.chance(0.5) ? kDisplay : kLinear;
        const TransferIntegral integral(randomTf(dice, 100.0), space);
        double v[3];
        for (double& value : v) {
            value = dice.uniform(-50.0, 150.0);
        }
        std::sort(v, v + 3);
        const glm::dvec4 parts =
            integral.mean(v[0], v[1]) * (v[1] - v[0]) + integral.mean(v[2], v[1]) * (v[2] - v[1]);
        const glm::dvec4 whole = integral.mean(v[2], v[0]) * (v[2] - v[0]);
        EXPECT_NEAR(glm::distance(parts, whole), 0.0, 1e-10 * (1.0 + whole.w));
    }
}

TEST(TransferIntegral, KeepsTheFaintBesideTheDense) {
    const TransferFunction tf = tfOf({{.value = 0.0, .opacity = 1.0},
                                      {.value = 1000.0, .opacity = 1.0},
                                      {.value = 1000.0, .opacity = 1e-12},
                                      {.value = 1001.0, .opacity = 1e-12}});
    EXPECT_NEAR(TransferIntegral(tf, kDisplay).mean(1000.0, 1001.0).w, 1e-12, 1e-23);
}

TEST(PreintegratedTable, HoldsTheMeansOfIntegersToAHalf) {
    Dice dice(3);
    for (int k = 0; k < 12; ++k) {
        const TransferFunction tf = randomTf(dice, 60.0);
        const CompositingSpace space = k % 2 == 0 ? kDisplay : kLinear;
        const PreintegratedTable table = makePreintegratedTable(tf, 0.0, 60.0, true, space, 128);
        const TransferIntegral integral(tf, space);
        // Below the smallest normal half, of the table's unit, rounding is absolute.
        const double absolute = 0x1p-24 * table.diagonal.extinctionPerMm;
        for (double f = 0.0; f <= 60.0; f += 1.0) {
            for (double b = 0.0; b <= 60.0; b += 1.0) {
                if (f == b) {
                    continue; // peaks are kept: below
                }
                const glm::dvec4 exact = integral.mean(f, b);
                const glm::dvec4 got = lookUp(table, f, b);
                const double bound = kHalfUnit * exact.w * (1.0 + 1e-9) + absolute;
                EXPECT_NEAR(glm::distance(got, exact), 0.0, 2.0 * bound) << f << " " << b;
                EXPECT_EQ(got, lookUp(table, b, f));
            }
        }
    }
}

TEST(PreintegratedTable, InterpolatesCurvedExtinctionWithinItsBound) {
    // A mean over [f, b] is that of s(f + (b - f) t), so its second derivative by either end is at
    // most a third of the largest of s; bilinear interpolation of texels h apart is off by at most
    // h^2/8 of both: h^2/12 of the largest s''. Here -ln(1 - u) over u in [0, 0.9].
    const TransferFunction tf =
        tfOf({{.value = 0.0, .opacity = 0.0}, {.value = 1000.0, .opacity = 0.9}});
    const PreintegratedTable table = makePreintegratedTable(tf, 0.0, 1000.0, false, kDisplay);
    ASSERT_EQ(table.size(), kMaxPreintegratedSize);
    const TransferIntegral integral(tf, kDisplay);
    const double texel = 1000.0 / (kMaxPreintegratedSize - 1);
    const double curve = std::pow(0.9e-3 / 0.1, 2.0);
    Dice dice(4);
    for (int k = 0; k < 20000; ++k) {
        const double f = dice.uniform(0.0, 1000.0);
        const double b = dice.chance(0.3) ? f : dice.uniform(0.0, 1000.0);
        const double exact = integral.mean(f, b).w;
        EXPECT_NEAR(lookUp(table, f, b).w, exact,
                    texel * texel * curve / 12.0 + kHalfUnit * (exact + texel * 0.009))
            << f << " " << b;
    }
}

TEST(PreintegratedTable, GoesOnBeyondItsValuesAsTheTfDoes) {
    // Flat outside [400, 500]; the table spans just that.
    const TransferFunction tf = tfOf({{.value = 400.0, .color = {1.0, 0.0, 0.0}, .opacity = 0.1},
                                      {.value = 500.0, .color = {0.0, 0.0, 1.0}, .opacity = 0.7}});
    const PreintegratedTable table = makePreintegratedTable(tf, -1000.0, 3000.0, true, kDisplay);
    EXPECT_EQ(table.size(), 101);
    const TransferIntegral integral(tf, kDisplay);
    Dice dice(5);
    for (int k = 0; k < 2000; ++k) {
        // Ends outside the table or on texels, so that nothing is interpolated.
        const auto anyEnd = [&dice] {
            return dice.chance(0.5) ? 400.0 + dice.below(101) : dice.uniform(-1000.0, 3000.0);
        };
        double f = anyEnd();
        double b = anyEnd();
        f = f > 400.0 && f < 500.0 ? std::round(f) : f;
        b = b > 400.0 && b < 500.0 ? std::round(b) : b;
        const glm::dvec4 exact = integral.mean(f, b);
        EXPECT_NEAR(glm::distance(lookUp(table, f, b), exact), 0.0, 2.0 * kHalfUnit * exact.w)
            << f << " " << b;
    }
}

TEST(PreintegratedTable, IsZeroExactlyWhereNothingIsVisible) {
    Dice dice(6);
    int zeros = 0;
    int seen = 0;
    for (int k = 0; k < 150; ++k) {
        const bool integers = dice.chance(0.5);
        const TransferFunction tf = randomTf(dice, 100.0);
        const PreintegratedTable table =
            makePreintegratedTable(tf, -5.0, 105.0, integers, kDisplay, integers ? 128 : 32);
        const TransferTable& axis = table.diagonal;
        const int last = table.size() - 1;
        for (int i = 0; i <= last; ++i) {
            for (int j = i + 1; j <= last; ++j) {
                const bool visible = visibleBetween(tf, axis.valueAt(i), axis.valueAt(j));
                EXPECT_EQ(table.at(i, j).w > 0.0F, visible) << i << " " << j;
                EXPECT_EQ(table.at(i, j), table.at(j, i));
                const auto from = axis.texels.begin() + i;
                const auto to = axis.texels.begin() + j + 1;
                // What skipping goes by.
                EXPECT_LE(visible, std::any_of(from, to, [](glm::vec4 t) { return t.w > 0.0F; }));
                (visible ? seen : zeros) += 1;
            }
        }
    }
    EXPECT_GT(zeros, 10000);
    EXPECT_GT(seen, 10000);
}

TEST(PreintegratedTable, LosesNothingVisibleForBeingNarrow) {
    Dice dice(7);
    for (int k = 0; k < 300; ++k) {
        const double middle = dice.uniform(1.0, 99.0);
        const double half = dice.logUniform(1e-6, 0.2);
        const TransferFunction tf = tfOf({{.value = 0.0, .opacity = 0.0},
                                          {.value = middle - half, .opacity = 0.0},
                                          {.value = middle, .opacity = 0.5},
                                          {.value = middle + half, .opacity = 0.0},
                                          {.value = 100.0, .opacity = 0.0}});
        const PreintegratedTable table = makePreintegratedTable(tf, 0.0, 100.0, true, kDisplay);
        EXPECT_GT(lookUp(table, middle, middle).w, 0.0) << middle;
        // Across, it counts by its area: half of the mean of its flank times its width.
        const double area = 2.0 * half * (depthIntegral(0.5) / 0.5);
        const glm::dvec4 across = lookUp(table, 0.0, 100.0);
        EXPECT_NEAR(across.w, area / 100.0,
                    kHalfUnit * area / 100.0 + 0x1p-24 * table.diagonal.extinctionPerMm);
    }
}

TEST(PreintegratedTable, OneValueIsOneMaterial) {
    const TransferFunction tf =
        tfOf({{.value = 0.0, .opacity = 0.0}, {.value = 10.0, .opacity = 1.0}});
    for (const bool integers : {true, false}) {
        const PreintegratedTable table = makePreintegratedTable(tf, 5.0, 5.0, integers, kDisplay);
        const double exact = -std::log(0.5);
        for (const double other : {5.0, 5.3, 6.0, 40.0, -3.0}) {
            EXPECT_NEAR(lookUp(table, 5.0, other).w, exact, kHalfUnit * exact) << other;
        }
    }
}

TEST(PreintegratedColorError, IsHalfOfWhatTheWeightsDifferBy) {
    double before = 0.0;
    for (const double depth : {1e-6, 0.009, 0.011, 0.3, 1.0, 2.3, 10.0, 300.0}) {
        // Weights exp(-t)/(1 - exp(-D)) and 1/D on a fine grid of t.
        constexpr int kSteps = 200000;
        double sum = 0.0;
        for (int k = 0; k < kSteps; ++k) {
            const double t = (k + 0.5) / kSteps * depth;
            sum += std::abs(std::exp(-t) * depth / -std::expm1(-depth) - 1.0);
        }
        const double error = preintegratedColorError(depth);
        EXPECT_NEAR(error, sum / kSteps / 2.0, 1e-5 * error + 1e-9) << depth;
        EXPECT_LE(error, std::min(1.0, depth / 8.0));
        EXPECT_GT(error, before);
        before = error;
    }
}

TEST(VisibleColorRange, IsThatOfVisibleColours) {
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 0.0, 0.0}, .opacity = 0.0},
                                      {.value = 10.0, .color = {0.2, 0.5, 0.5}, .opacity = 0.0},
                                      {.value = 20.0, .color = {0.8, 0.6, 0.5}, .opacity = 0.5},
                                      {.value = 20.0, .color = {0.7, 0.5, 0.5}, .opacity = 0.0},
                                      {.value = 30.0, .color = {0.7, 0.0, 1.0}, .opacity = 0.0}});
    EXPECT_NEAR(visibleColorRange(tf, 0.0, 30.0, kDisplay), 0.6, 1e-12);
    EXPECT_NEAR(visibleColorRange(tf, 15.0, 30.0, kDisplay), 0.3, 1e-12);
    EXPECT_EQ(visibleColorRange(tf, 0.0, 9.0, kDisplay), 0.0);
    EXPECT_EQ(visibleColorRange(tf, 21.0, 30.0, kDisplay), 0.0);
    EXPECT_NEAR(visibleColorRange(tf, 0.0, 30.0, kLinear),
                linearFromSrgb(glm::dvec3(0.8)).x - linearFromSrgb(glm::dvec3(0.2)).x, 1e-12);
}

} // namespace
} // namespace slabcast

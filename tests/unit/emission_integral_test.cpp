#include "core/reference/emission_integral.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/reference/gauss_kronrod.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;

constexpr double kTolerance = 1e-10;
const Cubic kUp{{0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}};
const Cubic kDown{{1.0, 2.0 / 3.0, 1.0 / 3.0, 0.0}};
const glm::dvec3 kBlue(0.0, 0.0, 1.0);
const glm::dvec3 kPink(1.0, 0.0, 1.0);

TransferRamp rampOf(double lowOpacity, double highOpacity, glm::dvec3 lowColor = kBlue,
                    glm::dvec3 highColor = kBlue) {
    return {0.0, 1.0, {lowColor, lowOpacity}, {highColor, highOpacity}};
}

EmissionIntegral integralOf(const TransferRamp& ramp, const Cubic& share, double lengthMm,
                            double unitMm = 1.0, double tolerance = kTolerance) {
    EmissionIntegral integral(unitMm, CompositingSpace::Display, tolerance);
    integral.add(ramp, share, lengthMm);
    return integral;
}

/// Of -ln(1 - o), from 0: (1 - o) ln(1 - o) + o, or its series where that cancels.
double integralOfExtinction(double opacity) {
    if (opacity > 0.01) {
        return (1.0 - opacity) * std::log1p(-opacity) + opacity;
    }
    double sum = 0.0;
    double power = opacity;
    for (int k = 1; k < 12; ++k) {
        power *= opacity;
        sum += power / (k * (k + 1.0));
    }
    return sum;
}

/// Mean of t over [0, 1], weighted by exp(-depth t): (1 - exp(-depth) (1 + depth)) / depth of it
/// all, or its series.
double redOfRisingColor(double depth) {
    if (depth > 0.1) {
        return (-std::expm1(-depth) - depth * std::exp(-depth)) / depth;
    }
    double sum = 0.0;
    double term = depth;
    for (int k = 1; k < 16; ++k) {
        sum += term / (k + 1.0);
        term *= -depth / k;
    }
    return sum;
}

TEST(GaussKronrod, IntegratesThePolynomialsThatItMust) {
    const GaussKronrod& rule = kGaussKronrod;
    for (int degree = 0; degree <= 22; ++degree) {
        double fine = 0.0;
        double coarse = 0.0;
        for (std::size_t i = 0; i < GaussKronrod::kNodes; ++i) {
            const double value = std::pow(rule.nodes[i], degree);
            fine += rule.weights[i] * value;
            coarse += rule.coarseWeights[i] * value;
            double inner = 0.0;
            for (std::size_t j = 0; j < GaussKronrod::kNodes; ++j) {
                inner += rule.integralTo[j][i] * std::pow(rule.nodes[j], degree);
            }
            if (degree <= 11) {
                EXPECT_NEAR(inner, std::pow(rule.nodes[i], degree + 1) / (degree + 1), 1e-15);
            }
        }
        EXPECT_NEAR(fine, 1.0 / (degree + 1), 1e-15) << degree;
        if (degree <= 13) {
            EXPECT_NEAR(coarse, 1.0 / (degree + 1), 1e-15) << degree;
        } else if (degree == 14) {
            EXPECT_GT(std::abs(coarse - 1.0 / 15.0), 1e-12);
        }
    }
}

TEST(EmissionIntegral, RampsOfOpacityFromTinyToFull) {
    for (const double low : {0.0, 1e-12, 1e-3, 0.5}) {
        for (const double high :
             {1e-12, 1e-7, 1e-3, 0.3, 0.9, 1.0 - 1e-4, 1.0 - 1e-7, kMaxOpacity}) {
            if (high <= 1.001 * low) {
                continue;
            }
            for (const double lengthMm : {1e-9, 1.0, 3.0}) {
                const double depth = (integralOfExtinction(high) - integralOfExtinction(low)) /
                                     (high - low) * lengthMm;
                for (const Cubic& share : {kUp, kDown}) {
                    const double alpha =
                        integralOf(rampOf(low, high), share, lengthMm).premultiplied().w;
                    EXPECT_NEAR(alpha / -std::expm1(-depth), 1.0, kTolerance)
                        << low << " to " << high << ", " << lengthMm << " mm";
                }
            }
        }
    }
}

TEST(EmissionIntegral, ColourRisingUnderOneExtinctionOf30Decades) {
    const double opacity = 0.5;
    for (double depth = 1e-15; depth < 1e15; depth *= 7.3) {
        const double lengthMm = depth / extinctionPerMm(opacity, 1.0);
        const EmissionIntegral up =
            integralOf(rampOf(opacity, opacity, kBlue, kPink), kUp, lengthMm);
        const glm::dvec4 pixel = up.premultiplied();
        const double alpha = -std::expm1(-depth);
        const double red = redOfRisingColor(depth);
        EXPECT_NEAR(pixel.w, alpha, kTolerance * alpha) << depth;
        EXPECT_NEAR(pixel.z, alpha, kTolerance * alpha) << depth;
        EXPECT_NEAR(pixel.x, red, kTolerance * alpha) << depth;
        const glm::dvec4 down =
            integralOf(rampOf(opacity, opacity, kBlue, kPink), kDown, lengthMm).premultiplied();
        EXPECT_NEAR(down.x, alpha - red, 2.0 * kTolerance * alpha) << depth;
        // As many halvings as the depth has digits, and a few stretches in front.
        EXPECT_LE(up.evaluations(), 20.0 + std::max(0.0, 1.5 * std::log2(depth))) << depth;
        EXPECT_TRUE(depth > 0.5 || up.evaluations() == 1) << depth;
    }
}

TEST(EmissionIntegral, NodesThatAgreeByChanceAreNotTrusted) {
    // A parabola of red that is the same at the first node of K15 and at that of G7, and so steep
    // an extinction that no node sees the front: alike, and wrong by the share at the front.
    const double vertex = 0.5 * (kGaussKronrod.nodes[0] + kGaussKronrod.nodes[1]);
    const Cubic parabola{{vertex * vertex, vertex * (vertex - 2.0 / 3.0),
                          vertex * (vertex - 4.0 / 3.0) + 1.0 / 3.0,
                          (1.0 - vertex) * (1.0 - vertex)}};
    const double depth = 2000.0;
    const glm::dvec4 pixel =
        integralOf(rampOf(0.5, 0.5, kBlue, kPink), parabola, depth / extinctionPerMm(0.5, 1.0))
            .premultiplied();
    // The mean of (s - vertex)^2 over exp(-depth s).
    const double red = 2.0 / (depth * depth) - 2.0 * vertex / depth + vertex * vertex;
    EXPECT_NEAR(pixel.x, red, kTolerance);
}

TEST(EmissionIntegral, TinyOpacitiesKeepTheirDigitsWhateverTheUnit) {
    // Opacity s^3 / 2 from either side of a ramp, under units that make its very beginning opaque:
    // -ln(1 - o) is o there, the depth A s^4, A = 1 / (8 unit); red, of s^3, is its mean over
    // d(alpha): the integral of exp(-A s^4) d(s^3), 3/4 Gamma(3/4) A^(-3/4).
    const Cubic grazing{{0.0, 0.0, 0.0, 1.0}};
    for (const double unitMm : {1e-9, 1e-15, 1e-20}) {
        const double a = 0.125 / unitMm;
        const double red = 0.75 * std::tgamma(0.75) * std::pow(a, -0.75);
        for (const TransferRamp& ramp :
             {rampOf(0.0, 0.5, kBlue, kPink), rampOf(0.5, 0.0, kPink, kBlue)}) {
            const EmissionIntegral integral = integralOf(ramp, grazing, 1.0, unitMm);
            const double largestOpacity = std::pow(30.0 / a, 0.75); // of what is seen
            EXPECT_NEAR(integral.premultiplied().x, red, kTolerance + red * largestOpacity);
            EXPECT_NEAR(integral.premultiplied().w, 1.0, kTolerance);
            EXPECT_LE(integral.evaluations(), 100);
        }
    }
}

TEST(EmissionIntegral, RoundingNextToFullOpacityDoesNotAskForever) {
    for (const double unitMm : {1e6, 1.0, 1e-3, 1e-9}) {
        for (const Cubic& share : {kUp, kDown, Cubic{{1.0, 1.0, 1.0, 0.0}}}) {
            const TransferRamp ramp = rampOf(0.0, kMaxOpacity, kBlue, kPink);
            const EmissionIntegral fine = integralOf(ramp, share, 1.0, unitMm, 1e-13);
            const EmissionIntegral coarse = integralOf(ramp, share, 1.0, unitMm, 1e-10);
            EXPECT_LE(fine.evaluations(), 500) << unitMm;
            const glm::dvec4 difference = fine.premultiplied() - coarse.premultiplied();
            EXPECT_LE(glm::length(difference), kTolerance * fine.premultiplied().w) << unitMm;
        }
    }
}

TEST(EmissionIntegral, UniformStretchesAndConstantColoursAreExact) {
    const TransferRamp uniform = rampOf(0.3, 0.3, kPink, kPink);
    for (const double lengthMm : {1e-15, 1.0, 50.0, 1e12}) {
        const EmissionIntegral integral = integralOf(uniform, {}, lengthMm, 0.01);
        const double alpha = -std::expm1(lengthMm / 0.01 * std::log1p(-0.3));
        EXPECT_NEAR(integral.premultiplied().w / alpha, 1.0, 1e-14);
        EXPECT_EQ(integral.premultiplied().x, integral.premultiplied().w);
        EXPECT_EQ(integral.evaluations(), 0);
    }
    const glm::dvec4 pixel = integralOf(rampOf(0.1, 0.8, kPink, kPink), kUp, 2.0).premultiplied();
    EXPECT_NEAR(pixel.x / pixel.w, 1.0, 1e-14);
}

TEST(EmissionIntegral, CutsChangeNothingBeyondTheTolerance) {
    Dice dice(7);
    for (int k = 0; k < 200; ++k) {
        const TransferRamp ramp =
            rampOf(dice.uniform(0.0, 1.0) * kMaxOpacity, dice.uniform(0.0, 1.0) * kMaxOpacity,
                   dice.inCube(0.05, 1.0), dice.inCube(0.05, 1.0)); // beyond the sRGB curve's joint
        const Cubic share{{dice.uniform(0.0, 1.0), dice.uniform(0.0, 1.0), dice.uniform(0.0, 1.0),
                           dice.uniform(0.0, 1.0)}};
        const double lengthMm = dice.logUniform(1e-4, 1e4);
        for (const CompositingSpace space : {CompositingSpace::Display, CompositingSpace::Linear}) {
            EmissionIntegral whole(1.0, space, kTolerance);
            whole.add(ramp, share, lengthMm);
            EmissionIntegral parts(1.0, space, kTolerance);
            double begin = 0.0;
            for (const double end : {0.1, 0.35, 0.4, 1.0}) {
                parts.add(ramp, share.part(begin, end), (end - begin) * lengthMm);
                begin = end;
            }
            // Either may leave the tolerance behind an opaque front, of four channels.
            const glm::dvec4 difference = parts.premultiplied() - whole.premultiplied();
            EXPECT_LE(glm::length(difference), 4.0 * kTolerance * whole.premultiplied().w) << k;
        }
    }
}

TEST(EmissionIntegral, EndsWhereNothingBehindShows) {
    EmissionIntegral integral(1.0, CompositingSpace::Display, kTolerance);
    integral.add(rampOf(0.5, 0.9, kPink, kPink), kUp, 5.0);
    EXPECT_FALSE(integral.isOpaque()); // (1 - 0.5)^5 at most
    integral.add(rampOf(0.5, 0.9, kPink, kPink), kUp, 40.0);
    EXPECT_TRUE(integral.isOpaque()); // 2^-45 at most
    const std::int64_t before = integral.evaluations();
    const glm::dvec4 pixel = integral.premultiplied();
    integral.add(rampOf(0.1, 0.9), kUp, 1.0);
    EXPECT_EQ(integral.evaluations(), before);
    EXPECT_EQ(integral.premultiplied(), pixel);
}

} // namespace
} // namespace slabcast

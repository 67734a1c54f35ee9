#include "core/reference/flip.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using Picture = std::vector<glm::dvec4>;

constexpr glm::ivec2 kSize(24, 17);

Picture uniform(glm::dvec3 color) {
    return Picture(static_cast<std::size_t>(kSize.x) * kSize.y, glm::dvec4(color, 1.0));
}

Picture noise(Dice& dice) {
    Picture picture = uniform({});
    for (glm::dvec4& pixel : picture) {
        pixel = glm::dvec4(dice.inCube(0.0, 1.0), 1.0);
    }
    return picture;
}

std::vector<double> flipOf(const Picture& one, const Picture& other,
                           double pixelsPerDegree = kPixelsPerDegree) {
    constexpr CompositingSpace kSpace = CompositingSpace::Display;
    return flip(flipPicture(one, kSize, kSpace, pixelsPerDegree),
                flipPicture(other, kSize, kSpace, pixelsPerDegree));
}

double meanOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) {
        sum += value;
    }
    return sum / static_cast<double>(values.size());
}

Picture mirrored(const Picture& picture) {
    Picture turned = picture;
    for (int y = 0; y < kSize.y; ++y) {
        const auto row = turned.begin() + static_cast<std::ptrdiff_t>(y) * kSize.x;
        std::reverse(row, row + kSize.x);
    }
    return turned;
}

TEST(Flip, OfEqualPicturesIsNothing) {
    Dice dice(1);
    const Picture picture = noise(dice);
    for (const double pixel : flipOf(picture, picture)) {
        EXPECT_EQ(pixel, 0.0);
    }
}

/// By hand: the largest difference is green (87.73, -75.61, 72.98 after Hunt's adjustment) against
/// blue (32.30, 25.58, -34.84): 55.43 + 147.86 = 203.29, to the power 0.7 41.27. White against
/// black is 100^0.7 = 25.12, beyond 0.4 * 41.27 = 16.51: 0.95 + 0.05 (25.12 - 16.51) / 24.76.
TEST(Flip, OfWhiteAgainstBlackIsAsThePapersFormulasHaveIt) {
    const double byHand = 0.95 + 0.05 * (25.119 - 0.4 * 41.27) / (0.6 * 41.27);
    ASSERT_NEAR(byHand, 0.9674, 1e-4);
    EXPECT_NEAR(flipOfColors(glm::dvec3(1.0), glm::dvec3(0.0)), byHand, 2e-4);
    EXPECT_NEAR(flipOfColors({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}), 1.0, 1e-12);
    for (const double pixel : flipOf(uniform(glm::dvec3(1.0)), uniform(glm::dvec3(0.0)))) {
        EXPECT_NEAR(pixel, byHand, 2e-4); // no feature, and nothing to blur
    }
}

/// L* is 100 to 0.95 * (dL^0.7 / 16.51): greys differ in lightness alone.
TEST(Flip, OfSmallDifferencesIsAPowerOfThem) {
    const auto lightness = [](double linear) { return 116.0 * std::cbrt(linear) - 16.0; };
    const double apart = lightness(0.2) - lightness(0.18);
    const double small = 0.4 * 41.27;
    EXPECT_NEAR(flipOfColors(glm::dvec3(0.2), glm::dvec3(0.18)),
                0.95 * std::pow(apart, 0.7) / small, 1e-4);
}

TEST(Flip, IsSymmetricAndTurnsWithThePicture) {
    Dice dice(2);
    const Picture one = noise(dice), other = noise(dice);
    const std::vector<double> there = flipOf(one, other), back = flipOf(other, one);
    const std::vector<double> turned = flipOf(mirrored(one), mirrored(other));
    for (int y = 0; y < kSize.y; ++y) {
        for (int x = 0; x < kSize.x; ++x) {
            const auto at = static_cast<std::size_t>(y) * kSize.x + x;
            EXPECT_GE(there[at], 0.0);
            EXPECT_LE(there[at], 1.0);
            EXPECT_EQ(there[at], back[at]);
            EXPECT_NEAR(turned[at + kSize.x - 1 - 2 * static_cast<std::size_t>(x)], there[at],
                        1e-9);
        }
    }
}

/// What the eye cannot resolve from afar, it cannot tell from its mean: light is averaged.
TEST(Flip, SeesACheckerboardFromNearAndNotFromAfar) {
    Picture board = uniform({});
    for (std::size_t i = 0; i < board.size(); ++i) {
        const double light = (i / kSize.x + i % kSize.x) % 2 == 0 ? 0.6 : 0.4;
        board[i] = glm::dvec4(srgbFromLinear(glm::dvec3(light)), 1.0);
    }
    const Picture mean = uniform(srgbFromLinear(glm::dvec3(0.5)));
    const double near = meanOf(flipOf(board, mean, 4.0));
    const double far = meanOf(flipOf(board, mean, 200.0));
    EXPECT_GT(near, 0.2);
    EXPECT_LT(far, 0.1 * near);
}

/// Of two changes as large in colour, the one that makes an edge counts for more.
TEST(Flip, AnEdgeRaisesTheDifferenceOfItsColours) {
    Picture edge = uniform(glm::dvec3(0.5));
    for (std::size_t i = 0; i < edge.size(); ++i) {
        edge[i] = glm::dvec4(glm::dvec3(i % kSize.x < 12 ? 0.4 : 0.5), 1.0);
    }
    const std::vector<double> changed = flipOf(edge, uniform(glm::dvec3(0.5)));
    const double uniformChange =
        flipOfColors(linearFromSrgb(glm::dvec3(0.4)), linearFromSrgb(glm::dvec3(0.5)));
    const std::size_t row = static_cast<std::size_t>(kSize.x) * 8;
    EXPECT_NEAR(changed[row], uniformChange, 1e-3); // far from the edge
    EXPECT_GT(changed[row + 10], 1.05 * uniformChange);
}

TEST(Flip, IsTheSameInBothSpaces) {
    Dice dice(3);
    const Picture encoded = noise(dice), other = noise(dice);
    const auto linear = [](Picture picture) {
        for (glm::dvec4& pixel : picture) {
            pixel = glm::dvec4(linearFromSrgb(glm::dvec3(pixel)), pixel.w);
        }
        return picture;
    };
    const auto inLight = flip(flipPicture(linear(encoded), kSize, CompositingSpace::Linear),
                              flipPicture(linear(other), kSize, CompositingSpace::Linear));
    const std::vector<double> inDisplay = flipOf(encoded, other);
    for (std::size_t i = 0; i < inLight.size(); ++i) {
        EXPECT_NEAR(inLight[i], inDisplay[i], 1e-12);
    }
}

} // namespace
} // namespace slabcast

#include "core/reference/picture_difference.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/frame_scene.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyInt;

constexpr CompositingSpace kSpaces[] = {CompositingSpace::Display, CompositingSpace::Linear};

struct Pair {
    glm::dvec3 lab1, lab2;
    double deltaE;
};

// Sharma, Wu and Dalal 2005, table 1: four decimals.
const Pair kPublished[] = {
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(DeltaE2000, IsAsPublished) {
    for (const Pair& pair : kPublished) {
        EXPECT_NEAR(deltaE2000(pair.lab1, pair.lab2), pair.deltaE, 0.5001e-4)
            << pair.lab2.x << " " << pair.lab2.y << " " << pair.lab2.z;
    }
}

glm::dvec3 anyColor() {
    const auto part = [] { return anyInt(0, 1001) / 1000.0; };
    const double r = part(), g = part(), b = part();
    return {r, g, b};
}

PROPERTY(DeltaE2000, IsSymmetricAndZeroOnlyOfEqualColours) {
    const glm::dvec3 one = labFromLinear(anyColor());
    const glm::dvec3 other = labFromLinear(anyColor());
    const double there = deltaE2000(one, other);
    PROPERTY_ASSERT(std::abs(there - deltaE2000(other, one)) <= 1e-9 * (1.0 + there));
    PROPERTY_ASSERT(deltaE2000(one, one) == 0.0);
    PROPERTY_ASSERT((there > 0.0) == (one != other));
}

TEST(Lab, WhiteBlackAndThePrimariesAreWhereTheyBelong) {
    const auto expectNear = [](glm::dvec3 lab, glm::dvec3 expected) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(lab[k], expected[k], 0.05);
        }
    };
    expectNear(labFromLinear({1.0, 1.0, 1.0}), {100.0, 0.0, 0.0});
    expectNear(labFromLinear({0.0, 0.0, 0.0}), {0.0, 0.0, 0.0});
    // The middle grey of photography has L* 49.5: 116 * cbrt(0.18) - 16.
    expectNear(labFromLinear(glm::dvec3(0.18)), {116.0 * std::cbrt(0.18) - 16.0, 0.0, 0.0});
    expectNear(labFromLinear({1.0, 0.0, 0.0}), {53.24, 80.09, 67.20});
    expectNear(labFromLinear({0.0, 0.0, 1.0}), {32.30, 79.19, -107.86});
}

TEST(PictureDifference, OfEqualPicturesIsNothing) {
    const std::vector<glm::dvec4> picture(100, glm::dvec4(0.1, 0.2, 0.3, 0.4));
    for (const CompositingSpace space : kSpaces) {
        const PictureDifference d = difference(picture, picture, space);
        EXPECT_EQ(d.rmse, 0.0);
        EXPECT_EQ(d.max, 0.0);
        EXPECT_EQ(d.meanDeltaE, 0.0);
        EXPECT_EQ(d.p999DeltaE, 0.0);
        EXPECT_TRUE(std::isinf(d.psnr) && d.psnr > 0.0);
    }
}

/// One channel of one pixel in n is off by d: rmse = d / sqrt(3n), psnr = -20 lg rmse.
TEST(PictureDifference, OfOnePixelIsKnown) {
    constexpr int kPixels = 400;
    constexpr double kOff = 0.25;
    const std::vector<glm::dvec4> reference(kPixels, glm::dvec4(0.5));
    std::vector<glm::dvec4> picture = reference;
    picture[7].y -= kOff;
    const PictureDifference d = difference(picture, reference, CompositingSpace::Display);
    const double rmse = kOff / std::sqrt(3.0 * kPixels);
    EXPECT_NEAR(d.rmse, rmse, 1e-15);
    EXPECT_NEAR(d.psnr, -20.0 * std::log10(rmse), 1e-12);
    EXPECT_EQ(d.max, kOff);
    EXPECT_NEAR(d.p999DeltaE, kPixels * d.meanDeltaE, 1e-12); // ceil(399.6) is the last: this pixel
}

/// Of 2000 pixels 99.9 % are 1998: two outliers are beyond the percentile, three are not.
TEST(PictureDifference, PercentileLeavesOutAThousandth) {
    const std::vector<glm::dvec4> reference(2000, glm::dvec4(0.5));
    std::vector<glm::dvec4> picture = reference;
    picture[3] = picture[1500] = glm::dvec4(1.0);
    EXPECT_EQ(difference(picture, reference, CompositingSpace::Display).p999DeltaE, 0.0);
    picture[900] = glm::dvec4(1.0);
    EXPECT_GT(difference(picture, reference, CompositingSpace::Display).p999DeltaE, 10.0);
}

TEST(PictureDifference, AlphaIsNotSeenOverBlack) {
    const std::vector<glm::dvec4> reference(4, glm::dvec4(0.5, 0.5, 0.5, 1.0));
    std::vector<glm::dvec4> picture = reference;
    picture[0].w = 0.6;
    EXPECT_EQ(difference(picture, reference, CompositingSpace::Display).rmse, 0.0);
}

/// The perceptual part is of the same two colours whichever space they are stored in.
TEST(PictureDifference, PerceptionDoesNotDependOnTheSpace) {
    const glm::dvec3 one(0.2, 0.5, 0.7), other(0.25, 0.45, 0.7); // encoded
    const auto of = [](glm::dvec3 color) { return std::array{glm::dvec4(color, 1.0)}; };
    const PictureDifference encoded = difference(of(one), of(other), CompositingSpace::Display);
    const PictureDifference light =
        difference(of(linearFromSrgb(one)), of(linearFromSrgb(other)), CompositingSpace::Linear);
    EXPECT_GT(encoded.meanDeltaE, 1.0);
    EXPECT_NEAR(encoded.meanDeltaE, light.meanDeltaE, 1e-12);
    EXPECT_NE(encoded.rmse, light.rmse);
}

/// Bias and scatter are told apart, and together they are the RMSE: per channel and in total.
TEST(PictureDifference, RmseIsBiasAndDeviation) {
    test::Dice dice(1);
    std::vector<glm::dvec4> reference, picture;
    const glm::dvec4 bias(0.01, -0.02, 0.003, -0.04);
    for (int i = 0; i < 500; ++i) {
        reference.emplace_back(dice.inCube(0.2, 0.8), 0.5);
        const glm::dvec4 noise(dice.inCube(-0.05, 0.05), dice.uniform(-0.01, 0.01));
        picture.push_back(reference.back() + bias + noise);
    }
    const PictureDifference d = difference(picture, reference, CompositingSpace::Display);
    double squares = 0.0, sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        const ErrorMoments& m = d.channels[static_cast<std::size_t>(k)];
        double own = 0.0, mean = 0.0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
            const double apart = picture[i][k] - reference[i][k];
            own += apart * apart / 500.0;
            mean += apart / 500.0;
        }
        EXPECT_NEAR(m.bias, mean, 1e-15);
        EXPECT_NEAR(m.bias, bias[k], 0.005); // 0.05 / sqrt(3 * 500) is 0.0013
        EXPECT_NEAR(m.bias * m.bias + m.deviation * m.deviation, own, 1e-15);
        EXPECT_NEAR(m.rmse * m.rmse, own, 1e-15);
        squares += k < 3 ? own / 3.0 : 0.0;
        sum += k < 3 ? mean / 3.0 : 0.0;
    }
    EXPECT_NEAR(d.bias, sum, 1e-15);
    EXPECT_NEAR(d.bias * d.bias + d.deviation * d.deviation, squares, 1e-15);
    EXPECT_NEAR(d.rmse * d.rmse, squares, 1e-15);
}

TEST(PictureDifference, APureBiasHasNoDeviation) {
    const std::vector<glm::dvec4> reference(64, glm::dvec4(0.25));
    const std::vector<glm::dvec4> picture(64, glm::dvec4(0.25 + 0x1p-6));
    const PictureDifference d = difference(picture, reference, CompositingSpace::Display);
    EXPECT_EQ(d.bias, 0x1p-6);
    EXPECT_EQ(d.deviation, 0.0);
    EXPECT_EQ(d.channels[3].bias, 0x1p-6);
}

/// A pixel counts once, however many of its channels are off; 1/255 itself is not beyond it.
TEST(PictureDifference, CountsThePixelsThatEightBitsWouldShow) {
    const std::vector<glm::dvec4> reference(8, glm::dvec4(0.0));
    std::vector<glm::dvec4> picture = reference;
    picture[0] = {1.01 / 255.0, 1.01 / 255.0, 0.0, 0.0};
    picture[1].z = -1.01 / 255.0;
    picture[2].x = 1.0 / 255.0;
    picture[3].w = 0.5;
    const PictureDifference d = difference(picture, reference, CompositingSpace::Display);
    EXPECT_EQ(d.visibleShare, 2.0 / 8.0);
    EXPECT_EQ(d.visibleAlphaShare, 1.0 / 8.0);
    EXPECT_EQ(d.channels[3].max, 0.5);
    EXPECT_EQ(d.max, 1.01 / 255.0);
}

} // namespace
} // namespace slabcast

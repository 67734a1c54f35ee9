#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/property.h"

#include "core/transfer/transfer_function.h"

namespace slabcast {
namespace {

using test::anyInt;
using test::checkProperty;

TransferFunction threePoints() {
    TransferFunction tf;
    tf.points = {{.value = 0.0, .color = {0.0, 0.0, 0.0}, .opacity = 0.0},
                 {.value = 10.0, .color = {1.0, 0.5, 0.0}, .opacity = 0.5},
                 {.value = 30.0, .color = {0.0, 1.0, 1.0}, .opacity = 0.1}};
    return tf;
}

void expectInvalid(const TransferFunction& tf, const std::string& path) {
    const Result<TransferFunction> result = validated(tf);
    ASSERT_FALSE(result.has_value()) << path;
    EXPECT_EQ(result.error().code, ErrorCode::InvalidTransferFunction);
    EXPECT_EQ(result.error().detail.rfind(path, 0), 0U) << result.error().detail;
}

TEST(TransferFunctionValidated, NamesTheOffendingEntry) {
    const double nan = std::nan("");
    ASSERT_TRUE(validated(threePoints()).has_value());
    TransferFunction tf = threePoints();
    tf.points.clear();
    expectInvalid(tf, "points");
    for (const double unit : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        tf = threePoints();
        tf.opacityUnitMm = unit;
        expectInvalid(tf, "opacityUnitMm");
    }
    for (const double value : {-1.0, nan, 1e300}) {
        tf = threePoints();
        tf.points[1].value = value;
        expectInvalid(tf, "points[1].value");
    }
    for (const double opacity : {-0.1, 1.1, nan}) {
        tf = threePoints();
        tf.points[2].opacity = opacity;
        expectInvalid(tf, "points[2].opacity");
    }
    for (const double channel : {-0.1, 1.1, nan}) {
        tf = threePoints();
        tf.points[0].color.z = channel;
        expectInvalid(tf, "points[0].color");
    }
    tf = threePoints();
    tf.points[0].value = tf.points[1].value = tf.points[2].value = 10.0;
    expectInvalid(tf, "points[2].value");
}

TEST(TransferFunctionValidated, KeepsExtinctionFinite) {
    TransferFunction tf = threePoints();
    tf.points[1].opacity = 1.0;
    const TransferFunction result = validated(tf).value();
    EXPECT_EQ(result.points[1].opacity, kMaxOpacity);
    EXPECT_EQ(result.points[2].opacity, 0.1);
    EXPECT_NEAR(extinctionPerMm(result.points[1].opacity, 1.0), 24.0 * std::log(2.0), 1e-9);
}

TEST(TransferFunctionEvaluate, IsPiecewiseLinearAndHoldsItsEnds) {
    const TransferFunction tf = threePoints();
    EXPECT_EQ(evaluate(tf, -5.0).opacity, 0.0);
    EXPECT_EQ(evaluate(tf, 10.0).opacity, 0.5);
    EXPECT_DOUBLE_EQ(evaluate(tf, 2.5).opacity, 0.125);
    EXPECT_DOUBLE_EQ(evaluate(tf, 25.0).opacity, 0.2);
    EXPECT_DOUBLE_EQ(evaluate(tf, 25.0).color.y, 0.875);
    EXPECT_EQ(evaluate(tf, 1e9).opacity, 0.1);
    EXPECT_EQ(evaluate(tf, 1e9).color, glm::dvec3(0.0, 1.0, 1.0));
}

TEST(TransferFunctionEvaluate, AStepHoldsFromItsValueOn) {
    TransferFunction tf;
    tf.points = {{.value = 5.0, .opacity = 0.25}, {.value = 5.0, .opacity = 0.75}};
    EXPECT_EQ(evaluate(tf, std::nextafter(5.0, 0.0)).opacity, 0.25);
    EXPECT_EQ(evaluate(tf, 5.0).opacity, 0.75);
    EXPECT_EQ(evaluate(tf, 6.0).opacity, 0.75);
}

TEST(Extinction, OfHalfAndOfFaintOpacity) {
    EXPECT_DOUBLE_EQ(extinctionPerMm(0.5, 2.0), std::log(2.0) / 2.0);
    EXPECT_EQ(extinctionPerMm(0.0, 1.0), 0.0);
    EXPECT_DOUBLE_EQ(extinctionPerMm(1e-20, 1.0), 1e-20); // 1 - 1e-20 is 1 in float64
}

TEST(Srgb, KnownValuesAndInverse) {
    EXPECT_NEAR(linearFromSrgb(glm::dvec3(0.5)).x, 0.21404114, 1e-8);
    EXPECT_NEAR(srgbFromLinear(glm::dvec3(0.18)).y, 0.46135613, 1e-8);
    EXPECT_EQ(linearFromSrgb(glm::dvec3(0.0)), glm::dvec3(0.0));
    EXPECT_NEAR(linearFromSrgb(glm::dvec3(1.0)).z, 1.0, 1e-15);
    checkProperty([] {
        const double encoded = anyInt(0, 1 << 20) / 1048575.0;
        // The two published thresholds leave a gap of about 3e-8 at the join.
        PROPERTY_ASSERT(std::abs(srgbFromLinear(linearFromSrgb(glm::dvec3(encoded))).x - encoded) <
                        1e-7);
    });
}

TEST(CompositingSpace, Names) {
    EXPECT_STREQ(name(CompositingSpace::Display), "display");
    EXPECT_STREQ(name(CompositingSpace::Linear), "linear");
}

} // namespace
} // namespace slabcast

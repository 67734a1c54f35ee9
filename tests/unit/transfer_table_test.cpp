#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/transfer/transfer_function.h"
#include "core/volume/half.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyBool;
using test::anyInt;

constexpr auto kDisplay = CompositingSpace::Display;
constexpr double kHalfUlp = 0x1p-11; // relative rounding of fp16

TransferFunction tfOf(std::vector<TransferPoint> points, double unitMm = 1.0) {
    TransferFunction tf;
    tf.opacityUnitMm = unitMm;
    tf.points = std::move(points);
    return validated(tf).value();
}

double valueOf(const TransferTable& table, std::size_t texel) {
    const std::size_t last = table.texels.size() - 1;
    return texel == last ? table.lastValue
                         : table.firstValue + static_cast<double>(texel) *
                                                  (table.lastValue - table.firstValue) /
                                                  static_cast<double>(last);
}

TEST(TransferTable, SpansTheKnotsOnIntegers) {
    const TransferFunction tf =
        tfOf({{.value = 150.0, .opacity = 0.0}, {.value = 700.0, .opacity = 0.5}});
    const TransferTable table = makeTable(tf, -1024.0, 3071.0, true, kDisplay);
    EXPECT_EQ(table.firstValue, 150.0);
    EXPECT_EQ(table.lastValue, 700.0);
    EXPECT_EQ(table.texels.size(), 551U);
    EXPECT_NEAR(lookUp(table, 700.0).w, std::log(2.0), std::log(2.0) * kHalfUlp);
    EXPECT_EQ(lookUp(table, 150.0).w, 0.0);
    EXPECT_EQ(lookUp(table, -1000.0).w, 0.0);
    EXPECT_EQ(lookUp(table, 3000.0).w, lookUp(table, 700.0).w);
}

TEST(TransferTable, IsCutToTheData) {
    const TransferFunction tf =
        tfOf({{.value = 0.0, .opacity = 0.0}, {.value = 1000.0, .opacity = 0.9}});
    const TransferTable table = makeTable(tf, 250.0, 300.0, true, kDisplay);
    EXPECT_EQ(table.firstValue, 250.0);
    EXPECT_EQ(table.lastValue, 300.0);
    const TransferTable floats = makeTable(tf, 0.25, 0.5, false, kDisplay, 64);
    EXPECT_EQ(floats.firstValue, 0.25);
    EXPECT_EQ(floats.lastValue, 0.5);
    EXPECT_EQ(floats.texels.size(), 64U);
}

TEST(TransferTable, TooManyIntegersTakeTheWholeTable) {
    const TransferFunction tf =
        tfOf({{.value = 0.0, .opacity = 0.0}, {.value = 60000.0, .opacity = 0.9}});
    EXPECT_EQ(makeTable(tf, 0.0, 65535.0, true, kDisplay).texels.size(), 4096U);
}

TEST(TransferTable, IsConstantWhereTheTfIs) {
    const TransferFunction tf =
        tfOf({{.value = 10.0, .opacity = 0.25}, {.value = 20.0, .opacity = 0.75}});
    const struct {
        double min;
        double max;
        double opacity;
    } cases[] = {{30.0, 90.0, 0.75},
                 {-9.0, 5.0, 0.25},
                 {15.0, 15.0, 0.5},
                 {20.0, 99.0, 0.75},
                 {1e9, 1e9, 0.75}};
    for (const auto& c : cases) {
        for (const bool integers : {true, false}) {
            const TransferTable table = makeTable(tf, c.min, c.max, integers, kDisplay);
            const double expected = -std::log(1.0 - c.opacity);
            EXPECT_LT(table.firstValue, table.lastValue);
            for (const double value : {c.min, c.max}) {
                EXPECT_NEAR(lookUp(table, value).w, expected, expected * kHalfUlp) << c.min;
            }
        }
    }
}

TEST(TransferTable, AStepAtTheFrontKeepsWhatLiesBelow) {
    const TransferFunction box = tfOf({{.value = 100.0, .opacity = 0.0},
                                       {.value = 100.0, .opacity = 0.5},
                                       {.value = 200.0, .opacity = 0.5},
                                       {.value = 200.0, .opacity = 0.0}});
    const TransferTable table = makeTable(box, 0.0, 255.0, true, kDisplay);
    EXPECT_EQ(lookUp(table, 0.0).w, 0.0);
    EXPECT_EQ(lookUp(table, 99.0).w, 0.0);
    EXPECT_NEAR(lookUp(table, 100.0).w, std::log(2.0), 1e-3);
    EXPECT_NEAR(lookUp(table, 199.0).w, std::log(2.0), 1e-3);
    EXPECT_EQ(lookUp(table, 200.0).w, 0.0);
    const TransferTable floats = makeTable(box, 0.0, 255.0, false, kDisplay);
    EXPECT_EQ(lookUp(floats, 99.9).w, 0.0);
    EXPECT_NEAR(lookUp(floats, 100.1).w, std::log(2.0), 1e-3);
    // Data that end at the step itself.
    for (const bool integers : {true, false}) {
        const TransferTable end = makeTable(box, 0.0, 100.0, integers, kDisplay);
        EXPECT_EQ(lookUp(end, 0.0).w, 0.0);
        EXPECT_NEAR(lookUp(end, 100.0).w, std::log(2.0), 1e-3);
    }
}

TEST(TransferTable, ColoursAreInterpolatedAsEncodedAndThenDecoded) {
    const TransferFunction tf = tfOf({{.value = 0.0, .color = glm::dvec3(0.0), .opacity = 0.1},
                                      {.value = 10.0, .color = glm::dvec3(1.0), .opacity = 0.1}});
    const TransferTable display = makeTable(tf, 0.0, 10.0, true, kDisplay);
    const TransferTable linear = makeTable(tf, 0.0, 10.0, true, CompositingSpace::Linear);
    EXPECT_EQ(lookUp(display, 5.0).x, 0.5);
    EXPECT_NEAR(lookUp(linear, 5.0).x, 0.21404114, 0.21404114 * kHalfUlp);
}

TEST(TransferTable, FaintStaysVisibleAndDenseStaysFinite) {
    const TransferFunction faint = tfOf({{.value = 0.0, .opacity = 0.0},
                                         {.value = 1.0, .opacity = 1e-12},
                                         {.value = 2.0, .opacity = 0.0}});
    EXPECT_NEAR(lookUp(makeTable(faint, 0.0, 2.0, true, kDisplay), 1.0).w, 1e-12, 1e-12 * kHalfUlp);
    const TransferFunction wide = tfOf({{.value = 0.0, .opacity = 1e-14},
                                        {.value = 1.0, .opacity = 0.5},
                                        {.value = 2.0, .opacity = 0.0}});
    const TransferTable table = makeTable(wide, 0.0, 2.0, true, kDisplay);
    EXPECT_TRUE(table.wide);
    EXPECT_NEAR(lookUp(table, 0.0).w, 1e-14, 1e-14 * 0x1p-23);
    EXPECT_NEAR(lookUp(table, 1.0).w, std::log(2.0), std::log(2.0) * 0x1p-23);
    EXPECT_FALSE(makeTable(faint, 0.0, 2.0, true, kDisplay).wide);
    const TransferFunction dense =
        tfOf({{.value = 0.0, .opacity = 0.0}, {.value = 1.0, .opacity = 1.0}}, 1e-6);
    const double densest = 24.0 * std::log(2.0) / 1e-6;
    EXPECT_NEAR(lookUp(makeTable(dense, 0.0, 1.0, true, kDisplay), 1.0).w, densest,
                densest * kHalfUlp);
}

TEST(TransferTable, AnIsolatedSpikeBetweenTexelsGoesToTheNearer) {
    const glm::dvec3 red(1.0, 0.0, 0.0);
    const TransferFunction spike =
        tfOf({{.value = 0.0, .color = glm::dvec3(0.0), .opacity = 0.0},
              {.value = 50.2, .color = glm::dvec3(0.0), .opacity = 0.0},
              {.value = 50.3, .color = red, .opacity = 0.5},
              {.value = 50.4, .color = glm::dvec3(0.0), .opacity = 0.0},
              {.value = 100.0, .color = glm::dvec3(0.0), .opacity = 0.0}});
    const TransferTable table = makeTable(spike, 0.0, 100.0, true, kDisplay);
    ASSERT_EQ(table.texels.size(), 101U);
    EXPECT_NEAR(lookUp(table, 50.0).w, std::log(2.0), 1e-3);
    EXPECT_EQ(table.texels[50].x, 1.0F);
    for (std::size_t k = 0; k < table.texels.size(); ++k) {
        EXPECT_TRUE(k == 50 || table.texels[k].w == 0.0F) << k;
    }
}

TEST(TransferTable, TheEndOfARampThatStepsToZeroOnATexelIsKept) {
    // Visible just below 50, exactly zero at 49 and from 50 on.
    const TransferFunction saw = tfOf({{.value = 0.0, .opacity = 0.0},
                                       {.value = 49.0, .opacity = 0.0},
                                       {.value = 50.0, .opacity = 0.5},
                                       {.value = 50.0, .opacity = 0.0},
                                       {.value = 99.0, .opacity = 0.0}});
    const TransferTable table = makeTable(saw, 0.0, 100.0, true, kDisplay);
    EXPECT_GT(lookUp(table, 49.5).w, 0.0);
}

/// Points in steps of a tenth, so that some fall between integers, on integers, and together.
TransferFunction anyTf() {
    TransferFunction tf;
    int value = anyInt(-300, 300);
    const int count = anyInt(1, 8);
    for (int i = 0; i < count; ++i) {
        const double opacity = std::max(0, anyInt(-100, 100)) / 100.0;
        tf.points.push_back({value / 10.0, glm::dvec3(anyInt(0, 100) / 100.0), opacity});
        const bool isStep =
            i > 0 && tf.points[static_cast<std::size_t>(i) - 1].value == tf.points.back().value;
        value += anyInt(isStep ? 1 : 0, 40);
    }
    return validated(tf).value();
}

PROPERTY(TransferTable, FollowsTheTfAtEveryTexel) {
    const TransferFunction tf = anyTf();
    const bool integers = anyBool();
    const TransferTable table = makeTable(tf, -40.0, 40.0, integers, kDisplay, 257);
    for (std::size_t k = 0; k < table.texels.size(); ++k) {
        const float alpha = table.texels[k].w;
        PROPERTY_ASSERT(!table.wide && roundedToHalf(alpha) == alpha);
        const double extinction = static_cast<double>(alpha) * table.extinctionPerMm;
        const TransferSample sample = evaluate(tf, valueOf(table, k));
        const double exact = extinctionPerMm(sample.opacity, 1.0);
        // Peaks between texels may raise a texel; nothing ever lowers one, to zero least of
        // all.
        PROPERTY_ASSERT(extinction >= exact * (1.0 - kHalfUlp));
        PROPERTY_ASSERT(sample.opacity == 0.0 || alpha > 0.0F);
    }
}

PROPERTY(TransferTable, ZeroTexelsMeanZeroTfAround) {
    const TransferFunction tf = anyTf();
    const bool integers = anyBool();
    const TransferTable table = makeTable(tf, -40.0, 40.0, integers, kDisplay, 257);
    // Nothing visible in the data may lie where the table and both texels beside it are empty.
    for (int i = -4000; i <= 4000; ++i) {
        const double value = i / 100.0;
        if (evaluate(tf, value).opacity > 0.0) {
            const double texel =
                (table.lastValue - table.firstValue) / static_cast<double>(table.texels.size() - 1);
            PROPERTY_ASSERT(lookUp(table, value).w > 0.0 || lookUp(table, value - texel).w > 0.0 ||
                            lookUp(table, value + texel).w > 0.0);
        }
    }
}

PROPERTY(TransferTable, WithoutNarrowPeaksZeroIsZero) {
    TransferFunction tf; // knots on integers only: no peak lies between two texels
    int value = anyInt(-30, 0);
    for (int i = 0; i < 6; ++i) {
        tf.points.push_back({double(value), glm::dvec3(1.0), std::max(0, anyInt(-9, 9)) / 10.0});
        value += anyInt(1, 12);
    }
    const TransferTable table = makeTable(tf, -40.0, 40.0, true, kDisplay);
    for (int v = -40; v <= 40; ++v) {
        const double opacity = evaluate(tf, v).opacity;
        const double alpha = lookUp(table, v).w;
        PROPERTY_ASSERT((alpha == 0.0) == (opacity == 0.0));
        PROPERTY_ASSERT(std::abs(alpha - extinctionPerMm(opacity, 1.0)) <= alpha * 0x1p-10);
    }
}

TEST(TransferTable, LookUpIsLinearBetweenTexels) {
    TransferTable table;
    table.firstValue = 10.0;
    table.lastValue = 14.0;
    table.texels = {glm::vec4(0.0F), glm::vec4(1.0F), glm::vec4(5.0F)};
    EXPECT_DOUBLE_EQ(lookUp(table, 11.0).x, 0.5);
    EXPECT_DOUBLE_EQ(lookUp(table, 13.5).w, 4.0);
    EXPECT_DOUBLE_EQ(lookUp(table, 14.0).y, 5.0);
    EXPECT_DOUBLE_EQ(lookUp(table, 99.0).z, 5.0);
    EXPECT_DOUBLE_EQ(lookUp(table, -99.0).z, 0.0);
}

TEST(TransferTable, APeakNextToAnEndStaysInside) {
    // What an end texel holds is what all values beyond read.
    const TransferPoint peaks[][3] = {
        {{0.0, glm::dvec3(1.0), 0.0}, {100.7, glm::dvec3(1.0), 0.9}, {100.7, glm::dvec3(1.0), 0.0}},
        {{0.0, glm::dvec3(1.0), 0.0}, {100.0, glm::dvec3(1.0), 0.9}, {100.0, glm::dvec3(1.0), 0.0}},
        {{7.1, glm::dvec3(1.0), 0.0}, {7.3, glm::dvec3(1.0), 0.9}, {90.0, glm::dvec3(1.0), 0.0}},
        {{7.1, glm::dvec3(1.0), 0.0}, {7.3, glm::dvec3(1.0), 0.9}, {7.4, glm::dvec3(1.0), 0.0}},
    };
    for (const auto& points : peaks) {
        const TransferFunction tf{.points = {points, points + 3}};
        for (const bool integers : {true, false}) {
            const TransferTable table =
                makeTable(tf, -50.0, 200.0, integers, CompositingSpace::Display, 512);
            EXPECT_EQ(lookUp(table, -50.0).w, 0.0) << points[1].value << " " << integers;
            EXPECT_EQ(lookUp(table, 200.0).w, 0.0) << points[1].value << " " << integers;
            EXPECT_GT(lookUp(table, points[1].value - 0.01).w, 0.0) << integers;
        }
    }
}

} // namespace
} // namespace slabcast

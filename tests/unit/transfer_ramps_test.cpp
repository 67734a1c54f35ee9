#include "core/reference/transfer_ramps.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/reference/material.h"
#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using test::tfOf;

TransferSample sampleAt(const TransferRamp& ramp, double value) {
    if (ramp.isUniform()) {
        return ramp.low;
    }
    const double share = (value - ramp.lowValue) / (ramp.highValue - ramp.lowValue);
    return {glm::mix(ramp.low.color, ramp.high.color, share),
            glm::mix(ramp.low.opacity, ramp.high.opacity, share)};
}

TransferFunction randomTransfer(Dice& dice) {
    std::vector<TransferPoint> points;
    double value = dice.uniform(-10.0, 10.0);
    const int count = 1 + dice.below(8);
    for (int k = 0; k < count; ++k) {
        points.push_back({.value = value,
                          .color = dice.inCube(0.0, dice.chance(0.5) ? 1.0 : 0.1),
                          .opacity = dice.chance(0.4) ? 0.0 : dice.uniform(0.0, 1.0)});
        const bool stepped = k > 0 && points[points.size() - 2].value == value;
        value += dice.chance(0.3) && !stepped ? 0.0 : dice.uniform(0.1, 5.0);
    }
    return tfOf(std::move(points));
}

TEST(TransferRamps, AreTheTransferFunction) {
    Dice dice(1);
    for (int k = 0; k < 500; ++k) {
        const TransferFunction tf = randomTransfer(dice);
        for (const CompositingSpace space : {CompositingSpace::Display, CompositingSpace::Linear}) {
            const TransferRamps ramps(tf, space);
            for (int i = 0; i < 50; ++i) {
                const bool atPoint = dice.chance(0.3);
                const auto point =
                    static_cast<std::size_t>(dice.below(static_cast<int>(tf.points.size())));
                const double value = atPoint ? tf.points[point].value : dice.uniform(-20.0, 50.0);
                const TransferRamp& ramp = ramps[ramps.holding(value)];
                EXPECT_LE(ramp.lowValue, value);
                EXPECT_LT(value, ramp.highValue);
                const TransferSample expected = evaluate(tf, value);
                EXPECT_NEAR(sampleAt(ramp, value).opacity, expected.opacity, 1e-13);
                EXPECT_NEAR(glm::distance(sampleAt(ramp, value).color, expected.color), 0.0, 1e-13);
            }
        }
    }
}

TEST(TransferRamps, FollowEachOtherOverAllValues) {
    Dice dice(2);
    for (int k = 0; k < 300; ++k) {
        const TransferFunction tf = randomTransfer(dice);
        const TransferRamps ramps(tf, CompositingSpace::Linear);
        double value = -std::numeric_limits<double>::infinity();
        int visible = 0;
        for (int i = 0; i < ramps.count(); ++i) {
            EXPECT_EQ(ramps[i].lowValue, value);
            EXPECT_GT(ramps[i].highValue, value);
            EXPECT_EQ(ramps.anyVisible(i, i), !ramps[i].isEmpty());
            visible += !ramps[i].isEmpty();
            EXPECT_EQ(ramps.anyVisible(0, i), visible > 0);
            value = ramps[i].highValue;
            if (i + 1 < ramps.count()) {
                EXPECT_EQ(ramps.endingAt(value), i);
                EXPECT_EQ(ramps.holding(value), i + 1);
                EXPECT_EQ(ramps.holding(value, -1e-9), i);
                EXPECT_EQ(ramps.endingAt(value, 1e-9), i + 1);
            }
        }
        EXPECT_EQ(value, std::numeric_limits<double>::infinity());
    }
}

TEST(TransferRamps, InLinearSpaceNoChannelPassesTheJointOfTheCurve) {
    const TransferFunction tf = tfOf({{.value = 0.0, .color = {0.0, 0.5, 1.0}, .opacity = 0.1},
                                      {.value = 1.0, .color = {0.0809, 0.5, 0.0}, .opacity = 0.3}});
    EXPECT_EQ(TransferRamps(tf, CompositingSpace::Display).count(), 3);
    const TransferRamps ramps(tf, CompositingSpace::Linear);
    ASSERT_EQ(ramps.count(), 5); // red passes at a half, blue at 1 - 0.04045
    EXPECT_NEAR(ramps[1].highValue, 0.5, 1e-15);
    EXPECT_NEAR(ramps[1].high.color.x, 0.04045, 1e-15);
    EXPECT_NEAR(ramps[1].high.opacity, 0.2, 1e-15);
    EXPECT_NEAR(ramps[2].highValue, 1.0 - 0.04045, 1e-15);
    EXPECT_NEAR(ramps[2].high.color.z, 0.04045, 1e-15);
}

TEST(TransferRamps, TellApartWhatASumWouldRound) {
    const double base = 1e6;
    const TransferRamps ramps(
        tfOf({{.value = base, .opacity = 0.0}, {.value = 2e6, .opacity = 0.5}}),
        CompositingSpace::Display);
    EXPECT_EQ(ramps.holding(base, -1e-30), 0);
    EXPECT_EQ(ramps.holding(base, 0.0), 1);
    EXPECT_EQ(ramps.endingAt(base, 0.0), 0);
    EXPECT_EQ(ramps.endingAt(base, 1e-30), 1);
}

} // namespace
} // namespace slabcast

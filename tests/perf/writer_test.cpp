#include "perf/edit/writer.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace slabcast;

namespace {

TransferFunction ramp(double top, double opacity, double unitMm = 1.0) {
    return {.name = "ramp",
            .opacityUnitMm = unitMm,
            .points = {{0.0, {1, 1, 1}, 0.0}, {top, {1, 0.5, 0}, opacity}}};
}

VolumeStatistics dataTo(double max) {
    VolumeStatistics data;
    data.min = 0.0;
    data.max = max;
    return data;
}

std::vector<bool> editsOf(const EditScript& script) {
    std::vector<bool> edits;
    for (const EditFrame& frame : script.frames) {
        edits.push_back(frame.newTransfer.has_value());
    }
    return edits;
}

TEST(MixedTransferFunctions, HalfOfEitherIsBetweenAtThePointsOfBoth) {
    const TransferFunction half = mixed(ramp(10.0, 0.4), ramp(20.0, 0.8), 0.5);
    ASSERT_EQ(half.points.size(), 3U); // 0, 10 and 20
    EXPECT_DOUBLE_EQ(half.points[1].value, 10.0);
    EXPECT_DOUBLE_EQ(half.points[1].opacity, 0.4); // 0.4 of the one and 0.4 of the other
    EXPECT_DOUBLE_EQ(half.points[2].opacity, 0.6); // 0.4, which holds on, and 0.8
    EXPECT_DOUBLE_EQ(half.points[2].color.g, 0.5);
}

TEST(MixedTransferFunctions, TheEndsAreTheFunctionsThemselves) {
    const TransferFunction a = ramp(10.0, 0.4);
    const TransferFunction b = ramp(20.0, 0.8);
    for (const double value : {-5.0, 0.0, 3.0, 10.0, 17.0, 20.0, 30.0}) {
        EXPECT_DOUBLE_EQ(evaluate(mixed(a, b, 0.0), value).opacity, evaluate(a, value).opacity);
        EXPECT_DOUBLE_EQ(evaluate(mixed(a, b, 1.0), value).opacity, evaluate(b, value).opacity);
    }
}

TEST(MixedTransferFunctions, AnotherUnitOfLengthIsTheSameMaterial) {
    // 0.75 along 2 mm is 0.5 along 1 mm.
    const TransferFunction both = mixed(ramp(10.0, 0.5), ramp(10.0, 0.75, 2.0), 0.3);
    EXPECT_DOUBLE_EQ(both.opacityUnitMm, 1.0);
    EXPECT_DOUBLE_EQ(both.points.back().opacity, 0.5);
}

TEST(MixedTransferFunctions, StepsStaySteps) {
    TransferFunction step = ramp(10.0, 0.4);
    step.points.insert(step.points.begin() + 1, {10.0, {1, 1, 1}, 0.0});
    const TransferFunction half = mixed(step, ramp(20.0, 0.8), 0.5);
    ASSERT_EQ(half.points.size(), 4U);
    EXPECT_DOUBLE_EQ(half.points[1].opacity, 0.2); // just below 10: 0 and 0.4
    EXPECT_DOUBLE_EQ(half.points[2].opacity, 0.4); // just above: 0.4 and 0.4
}

TEST(EditWriter, AnInterpolationGoesThereAndBack) {
    const VolumeStatistics data = dataTo(20.0);
    EditWriter writer(ramp(10.0, 0.4), data);
    writer.interpolate(ramp(10.0, 0.8), 1.0, 4);
    const EditScript script = writer.take();
    ASSERT_EQ(script.frames.size(), 4U);
    const double expected[] = {0.6, 0.8, 0.6, 0.4}; // by a sine in time
    for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_TRUE(script.frames[k].newTransfer);
        EXPECT_NEAR(script.frames[k].newTransfer->points.back().opacity, expected[k], 1e-15);
    }
}

TEST(EditWriter, WhatLooksAlikeIsNoEdit) {
    const VolumeStatistics data = dataTo(20.0);
    TransferFunction morePoints = ramp(10.0, 0.5);
    morePoints.points.insert(morePoints.points.begin() + 1, {5.0, {1, 0.75, 0.5}, 0.25});
    EditWriter writer(ramp(10.0, 0.5), data);
    writer.jump(morePoints, 2);
    writer.interpolate(ramp(10.0, 0.5), 1.0, 2);
    writer.dragOpacity(1, 0.5, 1);
    writer.jump(ramp(10.0, 0.6), 2);
    EXPECT_EQ(editsOf(writer.take()),
              (std::vector<bool>{false, false, false, false, false, true, false}));
}

TEST(EditWriter, ADragEndsAtItsOpacity) {
    const VolumeStatistics data = dataTo(20.0);
    EditWriter writer(ramp(10.0, 0.5), data);
    writer.dragOpacity(1, 0.1, 5);
    EXPECT_EQ(writer.now().points[1].opacity, 0.1);
    EXPECT_EQ(writer.now().points[0].opacity, 0.0);
}

TEST(EditWriter, RandomBandsLieInTheDataAndAreTheSeedsOwn) {
    const VolumeStatistics data = dataTo(100.0);
    const auto bands = [&](std::uint32_t seed) {
        EditWriter writer(ramp(10.0, 0.5), data);
        writer.random(seed, 2, 8);
        return writer.take();
    };
    const EditScript script = bands(7);
    EXPECT_EQ(editsOf(script),
              (std::vector<bool>{true, false, true, false, true, false, true, false}));
    for (const EditFrame& frame : script.frames) {
        if (frame.newTransfer) {
            ASSERT_EQ(frame.newTransfer->points.size(), 3U);
            EXPECT_GE(frame.newTransfer->points.front().value, 0.0);
            EXPECT_LT(frame.newTransfer->points.front().value,
                      frame.newTransfer->points.back().value);
        }
    }
    EXPECT_EQ(bands(7).frames[0].newTransfer->points[0].value,
              script.frames[0].newTransfer->points[0].value);
    EXPECT_NE(bands(8).frames[0].newTransfer->points[0].value,
              script.frames[0].newTransfer->points[0].value);
}

TEST(EditScripts, HaveAsManyFramesAsWereAskedFor) {
    const TransferFunction a = ramp(10.0, 0.4);
    for (const int frames : {20, 37, 240}) {
        EXPECT_EQ(interpolation(a, ramp(20.0, 0.8), frames).frames.size(),
                  static_cast<std::size_t>(frames));
        EXPECT_EQ(usualScript(a, dataTo(20.0), frames).frames.size(),
                  static_cast<std::size_t>(frames));
    }
}

TEST(EditScripts, AnInterpolationEndsWhereItBegan) {
    const TransferFunction a = ramp(10.0, 0.4);
    const EditScript script = interpolation(a, ramp(20.0, 0.8), 40);
    const TransferFunction* last = nullptr;
    for (const EditFrame& frame : script.frames) {
        last = frame.newTransfer ? &*frame.newTransfer : last;
    }
    ASSERT_NE(last, nullptr);
    for (const double value : {3.0, 10.0, 17.0, 20.0}) {
        EXPECT_NEAR(evaluate(*last, value).opacity, evaluate(a, value).opacity, 1e-15);
    }
}

} // namespace

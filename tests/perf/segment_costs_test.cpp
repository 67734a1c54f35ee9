#include "perf/model/segment_costs.h"

#include <gtest/gtest.h>

namespace slabcast {
namespace {

constexpr ShaderVariant kPlain{.unroll = 16};
constexpr ShaderVariant kSkipping{.skip = SkipForm::Balls, .unroll = 16};

TEST(SegmentCosts, PartsAddUpToTheWhole) {
    for (const GpuRates& gpu : gpuRates()) {
        const std::optional<SegmentCosts> plain = segmentCosts(gpu.compiler, kPlain);
        const std::optional<SegmentCosts> skipping = segmentCosts(gpu.compiler, kSkipping);
        ASSERT_TRUE(plain && skipping) << gpu.name;
        for (const SegmentCosts* costs : {&*plain, &*skipping}) {
            EXPECT_GT(costs->fragment.slots, 0.0) << gpu.name;
            EXPECT_GT(costs->layer.slots, 0.0) << gpu.name;
            EXPECT_GE(costs->layer.fetches, 1.0) << gpu.name; // the volume's
            EXPECT_GT(costs->codeBytes, 0.0) << gpu.name;
            EXPECT_EQ(costs->turn.slots, 0.0) << gpu.name;
        }
        EXPECT_EQ(plain->look.slots, 0.0) << gpu.name;
        EXPECT_GT(skipping->look.slots, 0.0) << gpu.name;
        EXPECT_EQ(skipping->layer.slots, plain->layer.slots) << gpu.name;
    }
}

TEST(SegmentCosts, ALoopGoesRoundAndASliceIsOneFragment) {
    for (const GpuRates& gpu : gpuRates()) {
        ShaderVariant loop = kSkipping;
        loop.unroll = 0;
        ASSERT_TRUE(segmentCosts(gpu.compiler, loop)) << gpu.name;
        EXPECT_GE(segmentCosts(gpu.compiler, loop)->turn.slots, 0.0);
        ShaderVariant slice = kPlain;
        slice.unroll = 1;
        const std::optional<SegmentCosts> costs = segmentCosts(gpu.compiler, slice);
        ASSERT_TRUE(costs) << gpu.name;
        EXPECT_EQ(costs->layer.slots, 0.0);
        EXPECT_GT(costs->fragment.slots, 0.0);
    }
}

TEST(SegmentCosts, LongerSegmentsAreMoreOfTheSame) {
    ShaderVariant longer = kSkipping;
    longer.unroll = 32;
    const SegmentCosts of16 = *segmentCosts("g71", kSkipping);
    const SegmentCosts of32 = *segmentCosts("g71", longer);
    EXPECT_EQ(of32.layer.slots, of16.layer.slots);
    EXPECT_EQ(of32.look.slots, of16.look.slots);
    EXPECT_GT(of32.codeBytes, 1.5 * of16.codeBytes);
}

TEST(SegmentCosts, WhatTheCompilersWereNotAskedForIsNothing) {
    EXPECT_FALSE(segmentCosts("nothing", kPlain));
    ShaderVariant lit = kPlain;
    lit.exactField = true;
    EXPECT_FALSE(segmentCosts("g71", lit));
}

} // namespace
} // namespace slabcast

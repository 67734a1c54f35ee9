#include "perf/model/frame_model.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace slabcast {
namespace {

/// Numbers that can be checked in one's head: a million clocks a second.
constexpr GpuRates kGpu{.name = "x",
                        .compiler = "x",
                        .title = "x",
                        .renderer = "x",
                        .megahertz = 1.0,
                        .cores = 2,
                        .issueSlots = 10.0,
                        .issueSlotsHigh = 20.0,
                        .texels = 4.0,
                        .fragments = 2.0,
                        .pixels = 2.0,
                        .texelsOf3d = 2.0,
                        .waveWidth = 2,
                        .waveHeight = 2,
                        .gigabytesPerSecond = 1.0,
                        .codeBytesLow = 1000,
                        .codeBytesHigh = 2000,
                        .source = "x"};

constexpr SegmentCosts kCosts{.fragment = {.slots = 30.0, .fetches = 0.0},
                              .layer = {.slots = 12.5, .fetches = 2.0},
                              .look = {.slots = 10.0, .fetches = 1.0},
                              .turn = {.slots = 5.0, .fetches = 0.0},
                              .codeBytes = 800.0};

FrameWork work() {
    FrameWork work;
    work.pixels = 100.0;
    work.fragments = 1000.0;
    work.layers = 4000.0;
    work.volumeFetches = 4000.0;
    work.looks = 2000.0;
    work.turns = 2000.0;
    return work;
}

TEST(FrameModel, TermsAreWorkTimesCostsOverRates) {
    const ModelTerms terms = modelFrame(work(), kCosts, kGpu);
    // 1000 clocks a ms. 1000 * 30 + 4000 * 12.5 + 2000 * 10 + 2000 turns * 5 slots, 10 a clock.
    EXPECT_DOUBLE_EQ(terms.issueMs, 110000.0 / 10.0 / 1000.0);
    // 4000 * (one of the volume, twice, and one of a table) + 2000 looks, 4 a clock.
    EXPECT_DOUBLE_EQ(terms.textureMs, 14000.0 / 4.0 / 1000.0);
    EXPECT_DOUBLE_EQ(terms.fragmentMs, 0.5);
    EXPECT_DOUBLE_EQ(terms.blendMs, 0.5);
    EXPECT_DOUBLE_EQ(terms.tileMs, 400.0 / 1e6);
    EXPECT_DOUBLE_EQ(terms.frameMs, terms.issueMs);
    EXPECT_DOUBLE_EQ(terms.lowMs, 5.5); // by the higher claim
    EXPECT_STREQ(terms.limit, "instructions");
    EXPECT_EQ(terms.divergenceMs, 0.0);
    EXPECT_EQ(terms.codeHighMs, 0.0);
}

TEST(FrameModel, EndsAreARaysAndNoMoreThanItsFragments) {
    SegmentCosts apart = kCosts;
    apart.ends = {.slots = 40.0, .fetches = 4.0};
    FrameWork drawn = work();
    drawn.rays = 250.0;
    const ModelTerms plain = modelFrame(drawn, kCosts, kGpu);
    EXPECT_DOUBLE_EQ(modelFrame(drawn, apart, kGpu).issueMs, plain.issueMs + 1.0);
    EXPECT_DOUBLE_EQ(modelFrame(drawn, apart, kGpu).textureMs, plain.textureMs + 0.25);
    drawn.rays = 2000.0;
    EXPECT_DOUBLE_EQ(modelFrame(drawn, apart, kGpu).issueMs, plain.issueMs + 4.0);
}

TEST(FrameModel, WideTexelsCostTwiceAgain) {
    FrameWork wide = work();
    wide.wideTexels = true;
    EXPECT_DOUBLE_EQ(modelFrame(wide, kCosts, kGpu).textureMs, 22.0 / 4.0);
}

TEST(FrameModel, DivergenceIsATermOfItsOwn) {
    FrameWork diverging = work();
    diverging.layerDivergence = 2.0;
    const ModelTerms terms = modelFrame(diverging, kCosts, kGpu);
    EXPECT_DOUBLE_EQ(terms.issueMs, 17.0); // turns, too
    EXPECT_DOUBLE_EQ(terms.divergenceMs, 6.0);
}

TEST(FrameModel, ManyPlanesAreLimitedByBlending) {
    FrameWork slicing = work();
    slicing.fragments = 1e6;
    slicing.layers = slicing.volumeFetches = slicing.looks = slicing.turns = 0.0;
    slicing.bytesPerPixel = 8.0;
    SegmentCosts lean = kCosts;
    lean.fragment.slots = 4.0;
    const ModelTerms terms = modelFrame(slicing, lean, kGpu);
    EXPECT_DOUBLE_EQ(terms.blendMs, 1000.0);
    EXPECT_DOUBLE_EQ(terms.fragmentMs, 500.0);
    EXPECT_STREQ(terms.limit, "blending");
}

TEST(FrameModel, CodeThatTheCacheDoesNotHoldIsARange) {
    SegmentCosts longer = kCosts;
    longer.codeBytes = 1640.0; // beyond what the cache holds at least: 640 bytes
    const ModelTerms terms = modelFrame(work(), longer, kGpu);
    EXPECT_EQ(terms.codeLowMs, 0.0);
    EXPECT_DOUBLE_EQ(terms.codeHighMs, 250.0 * 640.0 / (32.0 * 2.0) / 1000.0);
    EXPECT_DOUBLE_EQ(terms.highMs, terms.frameMs + terms.codeHighMs);
}

TEST(FrameModel, MemoryAndALayerOfOurOwn) {
    FrameWork stored = work();
    stored.layerOfOurOwn = true;
    stored.volumeBytes = 1e8;
    stored.views = 2;
    const ModelTerms terms = modelFrame(stored, kCosts, kGpu);
    EXPECT_DOUBLE_EQ(terms.tileMs, 1200.0 / 1e6);
    EXPECT_DOUBLE_EQ(terms.memoryMs, 200.0 + terms.tileMs);
    EXPECT_STREQ(terms.limit, "memory");
}

TEST(GpuRates, AreWholeAndFindable) {
    std::set<std::string> names;
    for (const GpuRates& gpu : gpuRates()) {
        EXPECT_TRUE(names.insert(gpu.name).second);
        EXPECT_EQ(findGpuRates(gpu.name), &gpu);
        for (const double rate : {gpu.megahertz, gpu.issueSlots, gpu.texels, gpu.fragments,
                                  gpu.pixels, gpu.texelsOf3d, gpu.gigabytesPerSecond}) {
            EXPECT_GT(rate, 0.0) << gpu.name;
        }
        EXPECT_GE(gpu.issueSlotsHigh, gpu.issueSlots);
        EXPECT_GE(gpu.codeBytesHigh, gpu.codeBytesLow);
        EXPECT_NE(std::string(gpu.source), "");
    }
    EXPECT_EQ(findGpuRates("nothing"), nullptr);
}

} // namespace
} // namespace slabcast

#include "perf/error/error_table.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace slabcast {
namespace {

const SceneLabel kSkull{"skull 8x8x8", "bone", "a", CompositingSpace::Display};
const SceneLabel kFoot{"foot 8x8x8", "bone", "b", CompositingSpace::Display};
const SceneLabel kHead{"head 8x8x8", "skin", "c", CompositingSpace::Display};

constexpr Sampling kCoarse{.layerSpacingVoxels = 4.0, .termination = {}};
constexpr Sampling kMiddle{.layerSpacingVoxels = 1.0, .termination = {}};
constexpr Sampling kFine{.layerSpacingVoxels = 0.25, .termination = {}};

MeasuredError measured(const SceneLabel& scene, const Sampling& sampling, double rmse, double ms) {
    return {.scene = scene,
            .size = {64, 64},
            .sampling = sampling,
            .rmse = rmse,
            .msPerMegapixel = ms,
            .commit = {}};
}

const std::vector<MeasuredError> kTable = {
    measured(kSkull, kCoarse, 0.1, 10.0),  measured(kSkull, kMiddle, 0.01, 30.0),
    measured(kSkull, kFine, 0.001, 100.0), measured(kFoot, kCoarse, 0.02, 12.0),
    measured(kFoot, kMiddle, 0.002, 40.0), measured(kFoot, kFine, 0.0002, 90.0),
};

Sampling chosen(double rmse, const SceneLabel& scene) {
    const Result<ErrorChoice> choice = cheapestWithin(rmse, scene, kTable);
    EXPECT_TRUE(choice.has_value());
    return choice ? choice->sampling : Sampling{};
}

TEST(ErrorTable, OfAMeasuredSceneTakesTheCheapestThatReaches) {
    EXPECT_EQ(chosen(0.2, kSkull), kCoarse);
    EXPECT_EQ(chosen(0.1, kSkull), kCoarse); // at most, not below
    EXPECT_EQ(chosen(0.05, kSkull), kMiddle);
    EXPECT_EQ(chosen(0.001, kSkull), kFine);
    EXPECT_EQ(chosen(0.05, kFoot), kCoarse);
}

TEST(ErrorTable, OfASceneNeverMeasuredExpectsTheWorstOfTheOthers) {
    const Result<ErrorChoice> choice = cheapestWithin(0.015, kHead, kTable);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->sampling, kMiddle);
    EXPECT_EQ(choice->expectedRmse, 0.01);
    EXPECT_EQ(choice->expectedMsPerMegapixel, 40.0);
    EXPECT_EQ(choice->measurements, 2);
    EXPECT_FALSE(choice->ofThisScene);
    EXPECT_TRUE(cheapestWithin(0.015, kSkull, kTable)->ofThisScene);
}

TEST(ErrorTable, WhatFewScenesWereMeasuredWithIsNotTrusted) {
    std::vector<MeasuredError> table = kTable;
    constexpr Sampling kLucky{.layerSpacingVoxels = 8.0, .termination = {}};
    table.push_back(measured(kFoot, kLucky, 1e-5, 1.0));
    EXPECT_EQ(cheapestWithin(0.015, kHead, table)->sampling, kMiddle);
    EXPECT_EQ(cheapestWithin(0.015, kFoot, table)->sampling, kLucky);
    table.push_back(measured(kSkull, kLucky, 1e-5, 1.0));
    EXPECT_EQ(cheapestWithin(0.015, kHead, table)->sampling, kLucky);
}

TEST(ErrorTable, SameVolumeUnderAnotherFunctionIsAnotherScene) {
    SceneLabel skin = kSkull;
    skin.tf = "skin";
    EXPECT_FALSE(cheapestWithin(0.5, skin, kTable)->ofThisScene);
}

TEST(ErrorTable, SameNamesOfOtherContentAreAnotherScene) {
    SceneLabel another = kSkull;
    another.fingerprint = "d";
    EXPECT_FALSE(cheapestWithin(0.5, another, kTable)->ofThisScene);
    EXPECT_TRUE(cheapestWithin(0.5, kSkull, kTable)->ofThisScene);
}

TEST(ErrorTable, WhatCannotBeReachedNamesTheBest) {
    const Result<ErrorChoice> choice = cheapestWithin(1e-4, kSkull, kTable);
    ASSERT_FALSE(choice);
    EXPECT_EQ(choice.error().code, ErrorCode::InvalidArgument);
    EXPECT_NE(choice.error().detail.find("0.001"), std::string::npos);
    EXPECT_NE(choice.error().detail.find("0.25 voxels"), std::string::npos);
    EXPECT_NE(choice.error().detail.find("slabcast error"), std::string::npos);
}

TEST(ErrorTable, OtherSpacesTellNothing) {
    const SceneLabel linear{kSkull.volume, kSkull.tf, kSkull.fingerprint, CompositingSpace::Linear};
    EXPECT_EQ(cheapestWithin(1.0, linear, kTable).error().code, ErrorCode::FileNotFound);
    EXPECT_EQ(cheapestWithin(1.0, kSkull, {}).error().code, ErrorCode::FileNotFound);
}

TEST(ErrorTable, SamplingReplacesWhatItNamesAndNothingElse) {
    SceneFacts facts;
    facts.sphere.radiusMm = 50.0; // 100 layers of a voxel
    Settings base;
    base.skip = SkipStructure::None;
    base.tighten = false;
    base.planes = 3;
    base.totalLayers = 7;
    base.form = SegmentForm::Unrolled;
    const Sampling sampling{.layerSpacingVoxels = 2.0,
                            .layersPerPlane = 8,
                            .classification = Classification::Pre,
                            .target = TargetFormat::Rgba16f,
                            .termination = 0.5};
    const Settings hybrid = withSampling(base, sampling, facts);
    EXPECT_EQ(totalLayers(hybrid, facts), 50);
    EXPECT_EQ(hybrid.layersPerPlane, 8);
    EXPECT_FALSE(hybrid.planes || hybrid.totalLayers);
    EXPECT_EQ(hybrid.classification, Classification::Pre);
    EXPECT_EQ(hybrid.target, TargetFormat::Rgba16f);
    EXPECT_EQ(hybrid.termination, 0.5);
    EXPECT_EQ(hybrid.skip, SkipStructure::None);
    EXPECT_FALSE(hybrid.tighten);
    EXPECT_EQ(hybrid.form, SegmentForm::Unrolled);
    Sampling all = kMiddle;
    EXPECT_EQ(withSampling(base, all, facts).layersPerPlane, 100);
    EXPECT_EQ(withSampling(base, all, facts).form, SegmentForm::Loop); // 100 cannot be written out
    all.jitter = true;
    EXPECT_EQ(withSampling(base, all, facts).layersPerPlane,
              totalLayers(withSampling(base, all, facts), facts)); // moved layers take one more
}

} // namespace
} // namespace slabcast

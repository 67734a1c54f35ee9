#include "core/plan/needs.h"

#include <gtest/gtest.h>

namespace slabcast {
namespace {

TEST(Needs, AreWhatTheSettingsDrawFrom) {
    const Needs needs = needsOf({.classification = Classification::Pre,
                                 .skip = SkipStructure::Chebyshev,
                                 .skipOptions = {.blockEdgeVoxels = 8},
                                 .skipBuilder = SkipBuilder::Cpu,
                                 .space = CompositingSpace::Linear,
                                 .shaded = true});
    EXPECT_EQ(needs.classification, Classification::Pre);
    EXPECT_EQ(needs.space, CompositingSpace::Linear);
    EXPECT_TRUE(needs.shaded);
    EXPECT_EQ(needs.skip.structure, SkipStructure::Chebyshev);
    EXPECT_EQ(needs.skip.blockEdgeVoxels, 8);
    EXPECT_EQ(needs.builder, SkipBuilder::Cpu);
}

TEST(Needs, NormalsAreBakedOfWhatIsLitSampleBySample) {
    EXPECT_TRUE(needsOf({.shaded = true, .normals = Normals::Baked}).normals);
    EXPECT_FALSE(needsOf({.shaded = true}).normals);
    EXPECT_FALSE(needsOf({.normals = Normals::Baked}).normals);
    const Classification pre = Classification::Pre;
    EXPECT_FALSE(
        needsOf({.classification = pre, .shaded = true, .normals = Normals::Baked}).normals);
}

TEST(Needs, TightPlanesNeedAStructure) {
    const SkipStructure none = SkipStructure::None;
    EXPECT_EQ(needsOf({.skip = none, .tighten = true}).skip.structure, SkipStructure::Blocks);
    EXPECT_EQ(needsOf({.skip = none, .tighten = false}).skip.structure, none);
    EXPECT_EQ(needsOf({.skip = SkipStructure::Proximity, .tighten = true}).skip.structure,
              SkipStructure::Proximity);
}

TEST(Needs, AutomaticSkippingTakesTheOptionsStructure) {
    EXPECT_EQ(needsOf({}).skip, SkipOptions{});
    EXPECT_EQ(needsOf({.skipOptions = {.structure = SkipStructure::MinMaxOctree}}).skip.structure,
              SkipStructure::MinMaxOctree);
}

} // namespace
} // namespace slabcast

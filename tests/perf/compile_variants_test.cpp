#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "perf/mobile/compile_variants.h"
#include "perf/mobile/reachable_variants.h"

namespace slabcast {
namespace {

TEST(CompileVariants, LabelsTellVariantsApart) {
    const std::set<ShaderVariant> variants = reachableVariants(1);
    std::set<std::string> labels;
    for (const ShaderVariant& variant : variants) {
        labels.insert(labelOf(variant));
    }
    EXPECT_EQ(labels.size(), variants.size());
    ShaderVariant variant{.unroll = 16, .lattice = LatticeKind::Shells, .jittered = true};
    EXPECT_EQ(labelOf(variant), name(variant) + " shells per ray");
    EXPECT_EQ(labelOf({.unroll = 4}), "post/unroll4");
}

TEST(CompileVariants, MoreChoicesReachMoreAndKeepWhatFewerReached) {
    const std::set<ShaderVariant> one = reachableVariants(1, true);
    const std::set<ShaderVariant> two = reachableVariants(2, true);
    EXPECT_TRUE(std::includes(two.begin(), two.end(), one.begin(), one.end()));
    EXPECT_GT(two.size(), one.size());
    EXPECT_EQ(
        two.count({.skip = SkipForm::Balls, .shaded = true, .terminates = true, .unroll = 16}), 1U);
}

TEST(CompileVariants, WhatPlansReachIsAmongAllThereIs) {
    const std::set<ShaderVariant> all = validVariants();
    const std::set<ShaderVariant> reached = reachableVariants(1);
    EXPECT_TRUE(std::includes(all.begin(), all.end(), reached.begin(), reached.end()));
    EXPECT_GT(all.size(), reached.size());
}

// Or the cost of a loop's layer could not be told.
TEST(CompileVariants, EveryLoopHasABody) {
    for (const ShaderVariant& variant : reachableVariants(1, true)) {
        if (variant.unroll == 0) {
            const std::string text = shaderText(variant).value().fragment;
            const std::optional<std::string> empty = withoutLoopBody(text);
            ASSERT_TRUE(empty) << labelOf(variant);
            EXPECT_NE(*empty, text);
        }
    }
}

TEST(CompileVariants, DescriptionsHoldEveryAxisThatVaries) {
    const Json shown = describe({.skip = SkipForm::Boxes, .unroll = 8, .jittered = true});
    EXPECT_EQ(shown.at("layers").whole(), 8);
    EXPECT_EQ(shown.at("axes").at("skip").text(), "boxes");
    EXPECT_EQ(shown.at("axes").at("jitter").text(), "per ray");
    EXPECT_EQ(shown.at("axes").at("lattice").text(), "planar");
    EXPECT_FALSE(shown.at("axes").contains("cover")); // of one value
}

TEST(CompileVariants, KeysTellTextsApart) {
    std::set<std::string> keys;
    std::set<ShaderVariant> variants;
    for (const ShaderVariant& variant : reachableVariants(1, true)) {
        if (variant.unroll <= 2) {
            variants.insert(variant);
        }
    }
    for (const ShaderVariant& variant : variants) {
        const std::string key = textKey(variant, {}).value();
        EXPECT_EQ(key.size(), 16U);
        EXPECT_EQ(textKey(variant, {}).value(), key);
        keys.insert(key);
    }
    EXPECT_EQ(keys.size(), variants.size());
    const ShaderVariant loop;
    EXPECT_NE(textKey(loop, {}).value(), textKey(loop, {.loopBodies = false}).value());
    EXPECT_FALSE(textKey({.unroll = 4}, {.loopBodies = false}));
}

TEST(CompileVariants, OnlyTheCallGoesFromALoop) {
    const std::string text = "void addGroup(inout Sum sum) {\n}\nwhile (k < end) {\n"
                             "    addGroup(sum);\n    k += 8.0;\n}\n";
    const std::optional<std::string> empty = withoutLoopBody(text);
    ASSERT_TRUE(empty);
    EXPECT_EQ(empty->size(), text.size()); // lines keep their numbers
    EXPECT_EQ(empty->find("    addGroup"), std::string::npos);
    EXPECT_NE(empty->find("void addGroup"), std::string::npos);
    EXPECT_NE(empty->find("k += 8.0;"), std::string::npos);
    EXPECT_FALSE(withoutLoopBody("while (k < end) {\n}\n"));
}

} // namespace
} // namespace slabcast

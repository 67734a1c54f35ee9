#include "core/scene/scene.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/scene/live_scene.h"
#include "core/volume/phantoms.h"

namespace slabcast {
namespace {

constexpr SkipOptions kNoSkip{.structure = SkipStructure::None};

Volume ball() {
    return makePhantom("phantom:sphere:16").value();
}

TransferFunction dense() {
    return {.name = "dense", .points = {{0.0, {1, 0, 0}, 0.0}, {255.0, {1, 0, 0}, 0.9}}};
}

TransferFunction thin() {
    return {.name = "thin", .points = {{0.0, {0, 1, 0}, 0.0}, {255.0, {0, 1, 0}, 0.1}}};
}

Scene ballScene(const Look& look = {.tf = dense()}) {
    Scene scene = Scene::create(ball(), TextureChoice{}).value();
    EXPECT_TRUE(scene.setLook(look).has_value());
    return scene;
}

ErrorCode codeOf(const Result<void>& result) {
    return result ? ErrorCode::Internal : result.error().code;
}

TEST(Scene, ATableOfNoTexelsIsRefused) {
    for (const int size : {-1, 0, 3}) {
        const Result<Scene> scene = Scene::create(ball(), TextureChoice{.maxTableSize = size});
        ASSERT_FALSE(scene.has_value()) << size;
        EXPECT_EQ(scene.error().code, ErrorCode::InvalidArgument);
    }
    EXPECT_TRUE(Scene::create(ball(), TextureChoice{.maxTableSize = 4}).has_value());
}

TEST(Scene, AVolumeThatNobodyValidatedIs) {
    const Device device(gl::Caps{.maxTextureSize = 2048}, {});
    Volume cut = ball();
    cut.voxels.resize(100);
    const Result<Scene> scene = Scene::create(std::move(cut), device);
    ASSERT_FALSE(scene.has_value());
    EXPECT_EQ(scene.error().code, ErrorCode::FileTruncated);
    EXPECT_TRUE(Scene::create(ball(), device).has_value());
}

TEST(Scene, ALookThatIsRefusedChangesNothing) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    const int generation = scene.lookGeneration();
    const double nan = std::nan("");
    const Look bad[] = {{.tf = {}},
                        {.tf = thin(), .shading = ShadingParameters{.diffuse = nan}},
                        {.tf = thin(), .bakedLightDirection = glm::dvec3(0.0)},
                        {.tf = thin(), .bakedLightDirection = glm::dvec3(nan)}};
    for (const Look& look : bad) {
        EXPECT_FALSE(scene.setLook(look).has_value());
        EXPECT_EQ(scene.lookGeneration(), generation);
        EXPECT_EQ(scene.look().tf.name, "dense");
        EXPECT_TRUE(scene.provides(needsOf({})));
    }
}

TEST(Scene, WithoutALookNothingCanBeProvided) {
    Scene scene = Scene::create(ball(), TextureChoice{}).value();
    EXPECT_EQ(codeOf(scene.provide(needsOf({}))), ErrorCode::InvalidArgument);
    EXPECT_FALSE(scene.provided().has_value());
}

TEST(Scene, ProvidesWhatIsNeededAndNothingElse) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide({.skip = kNoSkip}).has_value());
    EXPECT_FALSE(scene.table().texels.empty());
    EXPECT_EQ(scene.classified(), nullptr);
    EXPECT_EQ(scene.preintegrated(), nullptr);
    EXPECT_FALSE(scene.skip().exists());

    ASSERT_TRUE(scene.provide({.classification = Classification::Pre}).has_value());
    EXPECT_NE(scene.classified(), nullptr);

    ASSERT_TRUE(scene.provide({.classification = Classification::Preintegrated}).has_value());
    EXPECT_EQ(scene.classified(), nullptr);
    EXPECT_NE(scene.preintegrated(), nullptr);

    ASSERT_TRUE(scene.provide({.skip = {.structure = SkipStructure::Blocks}}).has_value());
    EXPECT_EQ(scene.preintegrated(), nullptr);
    EXPECT_EQ(scene.skip().options.structure, SkipStructure::Blocks);
}

TEST(Scene, KeepsWhatIsThere) {
    Scene scene = ballScene();
    const Needs needs = needsOf({});
    ASSERT_TRUE(scene.provide(needs).has_value());
    const int look = scene.lookGeneration();
    const int structure = scene.skip().generation;
    ASSERT_TRUE(scene.provide(needs).has_value());
    Needs lit = needs; // per sample: nothing is built for it
    lit.shaded = true;
    ASSERT_TRUE(scene.provide(lit).has_value());
    EXPECT_EQ(scene.provided()->shaded, true);
    Needs finer = lit;
    finer.skip.blockEdgeVoxels = 2;
    ASSERT_TRUE(scene.provide(finer).has_value());
    EXPECT_EQ(scene.lookGeneration(), look) << "the table is another one";
    EXPECT_NE(scene.skip().generation, structure);
}

TEST(Scene, NormalsAreOfTheTexelsAndOutliveALook) {
    Scene scene = ballScene();
    Needs needs{.shaded = true, .normals = true, .skip = kNoSkip};
    EXPECT_EQ(scene.normals(), nullptr);
    ASSERT_TRUE(scene.provide(needs).has_value());
    const NormalTexels* const baked = scene.normals();
    ASSERT_NE(baked, nullptr);
    EXPECT_GT(scene.facts().normals.places, 0);
    ASSERT_TRUE(scene.setLook({.tf = thin()}).has_value());
    EXPECT_FALSE(scene.provides(needs));
    ASSERT_TRUE(scene.provide(needs).has_value());
    EXPECT_EQ(scene.normals(), baked) << "baked again";
    // A floor above what they hold: another scale, so that light still fades where it should.
    ASSERT_TRUE(
        scene.setLook({.tf = thin(), .shading = {.gradientFloorPerMm = 2.0 * baked->steepestPerMm}})
            .has_value());
    const int generation = scene.normalsGeneration();
    ASSERT_TRUE(scene.provide(needs).has_value());
    EXPECT_NE(scene.normalsGeneration(), generation);
    needs.normals = false;
    ASSERT_TRUE(scene.provide(needs).has_value());
    EXPECT_EQ(scene.normals(), nullptr);
    scene.releaseTexels();
    needs.normals = true;
    EXPECT_EQ(codeOf(scene.provide(needs)), ErrorCode::InvalidArgument);
    EXPECT_FALSE(scene.provides(needs));
}

TEST(Scene, LightThatIsBakedInIsClassifiedAnew) {
    Scene scene = ballScene();
    Needs needs{.classification = Classification::Pre, .skip = kNoSkip};
    ASSERT_TRUE(scene.provide(needs).has_value());
    const std::vector<glm::u8vec4> unlit = scene.classified()->texels;
    needs.shaded = true;
    ASSERT_TRUE(scene.provide(needs).has_value());
    EXPECT_NE(scene.classified()->texels, unlit);
}

TEST(Scene, AnotherLookDropsWhatWasProvided) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    ASSERT_TRUE(scene.setLook({.tf = thin()}).has_value());
    EXPECT_FALSE(scene.provided().has_value());
    EXPECT_FALSE(scene.skip().exists());
    EXPECT_FALSE(scene.provides(needsOf({})));
}

TEST(Scene, WhatCannotBeBuiltLeavesAllElse) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    EXPECT_EQ(codeOf(scene.provide({.skip = {.blockEdgeVoxels = 3}})), ErrorCode::InvalidArgument);
    EXPECT_FALSE(scene.skip().exists());
    EXPECT_TRUE(scene.provides({.skip = kNoSkip}));
}

TEST(Scene, APlanOfAnUnprovidedSceneSaysWhatItNeeds) {
    const Scene scene = ballScene();
    const Settings settings{.skip = SkipStructure::Blocks};
    const Result<FramePlan> first = plan(scene.facts(), settings, gl::Caps{}, {});
    ASSERT_TRUE(first.has_value()) << first.error().detail;
    EXPECT_EQ(first->needs, needsOf(settings));
    Scene provided = scene;
    ASSERT_TRUE(provided.provide(first->needs).has_value());
    const Result<FramePlan> second = plan(provided.facts(), settings, gl::Caps{}, {});
    ASSERT_TRUE(second.has_value());
    EXPECT_EQ(second->needs, first->needs);
    EXPECT_EQ(second->skip, SkipStructure::Blocks);
    EXPECT_NE(second->look, first->look);
}

TEST(Scene, CodesAreMadeAgainWhenTheyAreNeeded) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    const double occupied = scene.skip().occupiedFraction;
    scene.releaseCodes();
    ASSERT_TRUE(scene.provide({.skip = {.structure = SkipStructure::Blocks}}).has_value());
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    EXPECT_EQ(scene.skip().occupiedFraction, occupied);
}

TEST(Scene, WithoutTexelsLooksChangeOnAndWhatIsMadeFromTexelsIsRefused) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    const Scene whole = scene;
    scene.releaseTexels();
    EXPECT_TRUE(scene.texels().data.empty());
    EXPECT_FALSE(whole.texels().data.empty());
    ASSERT_TRUE(scene.setLook({.tf = thin()}).has_value());
    EXPECT_TRUE(scene.provide(needsOf({})).has_value()) << "the codes are still there";
    EXPECT_EQ(codeOf(scene.provide({.classification = Classification::Pre})),
              ErrorCode::InvalidArgument);
    EXPECT_TRUE(LiveScene::start(scene).has_value());
    scene.releaseCodes();
    EXPECT_TRUE(scene.provide({.skip = kNoSkip}).has_value());
    EXPECT_EQ(codeOf(scene.provide(needsOf({}))), ErrorCode::InvalidArgument);
    EXPECT_FALSE(LiveScene::start(scene).has_value());
}

TEST(LiveScene, IsASceneWithALook) {
    const Result<LiveScene> bare = LiveScene::start(ballScene());
    ASSERT_FALSE(bare.has_value());
    EXPECT_EQ(bare.error().code, ErrorCode::InvalidArgument);
    Scene baked = ballScene();
    ASSERT_TRUE(baked.provide({.classification = Classification::Pre}).has_value());
    const Result<LiveScene> colors = LiveScene::start(std::move(baked));
    ASSERT_FALSE(colors.has_value());
    EXPECT_EQ(colors.error().code, ErrorCode::InvalidArgument);
}

TEST(LiveScene, GivesTheSceneBackWithWhatSkips) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    Result<LiveScene> live = LiveScene::start(std::move(scene), {.quietFrames = 0});
    ASSERT_TRUE(live.has_value()) << live.error().detail;
    ASSERT_TRUE(live->edit(thin()).has_value());
    EXPECT_EQ(live->scene().look().tf.name, "thin");
    EXPECT_FALSE(live->edit({}).has_value());
    EXPECT_EQ(live->scene().look().tf.name, "thin");
    const SkipStructure serving = live->live().current().options.structure;
    const Scene after = std::move(*live).stop();
    EXPECT_EQ(after.live(), nullptr);
    EXPECT_EQ(after.skip().options.structure, serving);
    EXPECT_EQ(after.look().tf.name, "thin");
}

} // namespace
} // namespace slabcast

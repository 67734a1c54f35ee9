#include "core/scene/scene.h"

#include <functional>
#include <string>
#include <vector>

#include "core/draw/prepare_check.h"
#include "core/scene/live_scene.h"
#include "tests/support/render_support.h"

namespace slabcast::test {
namespace {

constexpr SkipOptions kNoSkip{.structure = SkipStructure::None};

/// Of a scene through Device, Scene and Renderer as an application calls them.
class WayInTest : public RenderTest {
protected:
    Scene ballScene() {
        const Volume ball = makeVolume(glm::ivec3(24), VoxelType::U8, [](glm::ivec3 v) {
            return glm::length(glm::dvec3(v) - 11.5) < 8.0 ? 200.0 : 0.0;
        });
        Scene scene = Scene::create(ball, device()).value();
        EXPECT_TRUE(scene.setLook({.tf = transfer(0.5)}).has_value());
        return scene;
    }
    static TransferFunction transfer(double opacity) {
        return {.name = "ball", .points = {{0.0, {1, 0, 0}, 0.0}, {255.0, {1, 0, 0}, opacity}}};
    }
    static Result<void> prepare(Renderer& renderer, const Scene& scene, const FramePlan& plan) {
        const ViewTarget target{asymmetricView(scene), 0, {0, 0, kSize.x, kSize.y}};
        return renderer.prepare(scene, plan, {&target, 1});
    }
    static void expectRefused(const Result<void>& result, const std::string& says) {
        ASSERT_FALSE(result.has_value()) << says;
        EXPECT_EQ(result.error().code, ErrorCode::InvalidArgument);
        EXPECT_NE(result.error().detail.find(says), std::string::npos) << result.error().detail;
    }
};

TEST_F(WayInTest, ADeviceTestsItself) {
    const Result<Device> opened = Device::open(getProc());
    ASSERT_TRUE(opened.has_value()) << opened.error().detail;
    ASSERT_EQ(opened->formats().size(), 5U);
    EXPECT_TRUE(opened->formats()[0].usable) << opened->formats()[0].reason;
    EXPECT_GE(opened->texturesFor(VoxelType::U8, {}).maxTableSize, 2048);
}

TEST_F(WayInTest, TheOneCallIsThePlanOfTheSteps) {
    Scene oneCall = ballScene();
    const Settings settings;
    const Result<FramePlan> all = renderer().plan(oneCall, settings);
    ASSERT_TRUE(all.has_value()) << all.error().detail;
    Scene steps = ballScene();
    ASSERT_TRUE(steps.provide(needsOf(settings)).has_value());
    EXPECT_EQ(*all, decide(steps, settings));
    EXPECT_EQ(differingPixels(draw(oneCall, *all, asymmetricView(oneCall), kSize),
                              draw(steps, decide(steps, settings), asymmetricView(steps), kSize)),
              0);
}

TEST_F(WayInTest, WhereTheGpuCannotBuildTheCpuDoesAndALineSaysSo) {
    gl::Caps weak = caps();
    weak.maxComputeSharedBytes = 0;
    std::vector<std::string> lines;
    Result<Renderer> own = Renderer::create(
        Device(weak, formats(), {.log = [&](const std::string& line) { lines.push_back(line); }}));
    ASSERT_TRUE(own.has_value());
    Scene scene = ballScene();
    Needs needs = needsOf({});
    needs.builder = SkipBuilder::Gpu;
    ASSERT_TRUE(own->provide(scene, needs).has_value());
    EXPECT_FALSE(scene.skip().onGpu);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("CPU"), std::string::npos) << lines[0];
    ASSERT_TRUE(own->provide(scene, needs).has_value());
    EXPECT_EQ(lines.size(), 1U) << "what is there is not built again";
}

TEST_F(WayInTest, AutomaticBuildersFollowTheQuirk) {
    for (const bool slow : {true, false}) {
        Result<Renderer> own = Renderer::create(device({.quirks = Quirks{.computeIsSlow = slow}}));
        ASSERT_TRUE(own.has_value());
        Scene scene = ballScene();
        ASSERT_TRUE(own->provide(scene, needsOf({})).has_value());
        EXPECT_EQ(scene.skip().onGpu, !slow);
    }
}

TEST_F(WayInTest, APlanBeforeAnythingIsProvidedIsRefused) {
    const Scene scene = ballScene();
    expectRefused(prepare(renderer(), scene, decide(scene, {})), "nothing was provided");
}

TEST_F(WayInTest, APlanOfAnotherLookIsRefused) {
    Scene scene = ballScene();
    const FramePlan before = renderer().plan(scene, {}).value();
    ASSERT_TRUE(prepare(renderer(), scene, before).has_value());
    ASSERT_TRUE(scene.setLook({.tf = transfer(0.9)}).has_value());
    ASSERT_TRUE(renderer().provide(scene, before.needs).has_value());
    expectRefused(prepare(renderer(), scene, before), "another look");
    ASSERT_TRUE(prepare(renderer(), scene, decide(scene, {})).has_value());
}

TEST_F(WayInTest, AStalePlanThatDrewNothingIsRefused) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.setLook({.tf = transfer(0.0)}).has_value());
    const FramePlan nothing = renderer().plan(scene, {}).value();
    ASSERT_TRUE(nothing.drawsNothing);
    ASSERT_TRUE(prepare(renderer(), scene, nothing).has_value());
    ASSERT_TRUE(scene.setLook({.tf = transfer(0.9)}).has_value());
    ASSERT_TRUE(renderer().provide(scene, nothing.needs).has_value());
    expectRefused(prepare(renderer(), scene, nothing), "another look");
}

TEST_F(WayInTest, ATightenedPlanWithoutAStructureIsRefused) {
    Scene scene = ballScene();
    const FramePlan tight = renderer().plan(scene, {.skip = SkipStructure::None}).value();
    ASSERT_TRUE(tight.tighten);
    ASSERT_TRUE(scene.provide({.skip = kNoSkip}).has_value());
    expectRefused(prepare(renderer(), scene, tight), "tighten");
    const FramePlan loose =
        renderer().plan(scene, {.skip = SkipStructure::None, .tighten = false}).value();
    ASSERT_TRUE(prepare(renderer(), scene, loose).has_value());
}

TEST_F(WayInTest, APlanForAnotherStructureIsRefused) {
    Scene scene = ballScene();
    const FramePlan cloud = renderer().plan(scene, {.skip = SkipStructure::Proximity}).value();
    ASSERT_TRUE(scene.provide({.skip = {.structure = SkipStructure::MinMaxOctree}}).has_value());
    expectRefused(prepare(renderer(), scene, cloud), "skips by proximity");
}

TEST_F(WayInTest, APlanOfTheSettingsBeforeIsRefused) {
    Scene scene = ballScene();
    const FramePlan display = renderer().plan(scene, {}).value();
    const Settings linear{.space = CompositingSpace::Linear};
    ASSERT_TRUE(renderer().plan(scene, linear).has_value());
    expectRefused(prepare(renderer(), scene, display), "another look");
}

TEST_F(WayInTest, WhatWasNotPreparedIsNotDrawn) {
    Scene scene = ballScene();
    const FramePlan plan = renderer().plan(scene, {}).value();
    Result<Renderer> own = Renderer::create(device());
    ASSERT_TRUE(own.has_value());
    const ViewTarget target{asymmetricView(scene), 0, {0, 0, 8, 8}};
    expectRefused(own->draw(scene, plan, {&target, 1}), "not prepared");
}

TEST_F(WayInTest, AfterAnEditPlansAreMadeAnew) {
    Scene scene = ballScene();
    ASSERT_TRUE(scene.provide(needsOf({})).has_value());
    Result<LiveScene> live = LiveScene::start(std::move(scene), {.quietFrames = 0});
    ASSERT_TRUE(live.has_value());
    const FramePlan before = decide(*live, {});
    ASSERT_TRUE(prepare(renderer(), *live, before).has_value());
    ASSERT_TRUE(live->edit(transfer(0.9)).has_value());
    expectRefused(prepare(renderer(), *live, before), "another look");
    const FramePlan after = decide(*live, {});
    ASSERT_TRUE(prepare(renderer(), *live, after).has_value());
}

TEST_F(WayInTest, WithoutTexelsDrawingGoesOnButNotInAnotherRenderer) {
    Scene scene = ballScene();
    const FramePlan plan = renderer().plan(scene, {}).value();
    const Picture before = draw(scene, plan, asymmetricView(scene), kSize);
    scene.releaseTexels();
    EXPECT_EQ(differingPixels(draw(scene, plan, asymmetricView(scene), kSize), before), 0);
    Result<Renderer> other = Renderer::create(device());
    ASSERT_TRUE(other.has_value());
    expectRefused(prepare(*other, scene, plan), "let go of its texels");
}

TEST_F(WayInTest, ViewsThatGiveNoPictureAreRefusedByTheirIndex) {
    Scene scene = ballScene();
    View flat = asymmetricView(scene);
    flat.viewFromModel = glm::dmat4(0.0);
    const FramePlan plan = renderer().plan(scene, {}).value();
    ViewTarget targets[] = {{asymmetricView(scene), 0, {0, 0, 8, 8}}, {flat, 0, {0, 0, 8, 8}}};
    expectRefused(renderer().prepare(scene, plan, targets), "view 1: ");
    ASSERT_TRUE(renderer().prepare(scene, plan, {targets, 1}).has_value());
    expectRefused(renderer().draw(scene, plan, targets), "view 1: ");
    targets[1].viewport = {}; // a window made small is not drawn in
    EXPECT_TRUE(renderer().prepare(scene, plan, targets).has_value());
}

} // namespace
} // namespace slabcast::test

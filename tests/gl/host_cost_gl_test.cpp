#include <string>

#include "core/gl/state_guard.h"
#include "tests/support/host_cost.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

constexpr glm::ivec2 kEye(256, 512); // two of them: 512x512

Volume ball(int edge) {
    return makeVolume(glm::ivec3(edge), VoxelType::U8, [=](glm::ivec3 v) {
        const glm::dvec3 p = (glm::dvec3(v) + 0.5) / double(edge) * 2.0 - 1.0;
        return 255.0 * std::max(0.0, 1.0 - glm::length(p) * 1.2);
    });
}

TransferFunction band(double low, double opacity = 0.4) {
    const glm::dvec3 color(0.9, 0.5, 0.3);
    return {.name = "band",
            .points = {{low, color, 0.0}, {low + 60.0, color, opacity}, {200.0, color, 0.0}}};
}

Settings bySixteen() {
    Settings settings;
    settings.layersPerPlane = 16;
    settings.form = SegmentForm::Loop;
    return settings;
}

} // namespace

/// What frames cost the host: counts, the same on every machine. perf/README.md has them beside
/// those of before.
class HostCostTest : public RenderTest {
protected:
    void SetUp() override {
        RenderTest::SetUp();
        ASSERT_TRUE(target_.resize(2 * kEye.x, kEye.y, {GL_RGBA8}).has_value());
        target_.begin();
    }

    std::vector<ViewTarget> eyes(const Scene& scene, double azimuth) {
        const auto pair = stereoViews(orbitView(scene, {azimuth, 15.0, 2.2}, 50.0, kEye), 8.0,
                                      2.2 * scene.geometry().boundingSphere().radiusMm);
        return {{pair[0], target_.framebuffer(), {0, 0, kEye.x, kEye.y}},
                {pair[1], target_.framebuffer(), {kEye.x, 0, kEye.x, kEye.y}}};
    }

    /// Of a frame after others, the head turned, and of prepare() with nothing to do.
    struct Steady {
        HostCost draw;
        HostCost prepare;
        std::string listed;
    };
    Steady steady(Renderer& renderer, const Scene& scene, const FramePlan& plan) {
        const std::vector<ViewTarget> first = eyes(scene, 20.0);
        const std::vector<ViewTarget> turned = eyes(scene, 25.0);
        EXPECT_TRUE(renderer.prepare(scene, plan, first).has_value());
        EXPECT_TRUE(renderer.draw(scene, plan, first).has_value());
        HostCostCounter counter;
        Steady cost;
        EXPECT_TRUE(renderer.prepare(scene, plan, turned).has_value());
        cost.prepare = counter.take();
        EXPECT_TRUE(renderer.draw(scene, plan, turned).has_value());
        cost.draw = counter.take();
        cost.listed = counter.listed();
        return cost;
    }
    Renderer make(HostState hostState) { return std::move(*Renderer::create(device(), hostState)); }

    gl::ColorTargets target_;
};

TEST_F(HostCostTest, ADrawIsCommandsAlone) {
    const Scene scene = makeScene(ball(64), {.tf = band(60.0)});
    const gl::StateGuard forOtherTests; // one renderer leaves its own state
    Renderer ours = make(HostState::Ours);
    Renderer restoring = make(HostState::Restore);
    struct Way {
        const char* name;
        BlendOrder order;
        int calls; // of two views, under Ours
    };
    for (const Way& way : {Way{"planes over the target", BlendOrder::BackToFront, 38},
                           Way{"a layer of our own", BlendOrder::FrontToBack, 56}}) {
        SCOPED_TRACE(way.name);
        Settings settings = bySixteen();
        settings.order = way.order;
        settings.termination.reset();
        const FramePlan plan = decide(scene, settings);
        ASSERT_TRUE(plan.tighten && plan.skip != SkipStructure::None);
        const Steady own = steady(ours, scene, plan);
        EXPECT_EQ(own.draw.queries, 0) << own.listed;
        EXPECT_EQ(own.draw.calls, way.calls) << own.listed;
        EXPECT_LE(own.draw.calls, 2 * 40);
        EXPECT_EQ(own.draw.uploads, 1);
        EXPECT_EQ(own.draw.makes, 0);
        EXPECT_EQ(own.draw.allocations, 0);
        EXPECT_EQ(own.draw.threads, 0);
        const Steady guarded = steady(restoring, scene, plan);
        // The guard's queries and what it sets back, once for the frame. One of them is of the
        // program that is current: whether it is deleted.
        EXPECT_EQ(guarded.draw.queries, 94 + 1);
        EXPECT_EQ(guarded.draw.calls, own.draw.calls + 188 + 1) << guarded.listed;
        EXPECT_EQ(guarded.draw.allocations, 0);
        for (const Steady* one : {&own, &guarded}) {
            EXPECT_EQ(one->prepare.calls, 0);
            EXPECT_EQ(one->prepare.allocations, 0);
        }
    }
}

TEST_F(HostCostTest, OneViewTakesFortyCallsAtMost) {
    const Scene scene = makeScene(ball(32), {.tf = band(60.0)});
    const gl::StateGuard forOtherTests;
    Renderer ours = make(HostState::Ours);
    for (const BlendOrder order : {BlendOrder::BackToFront, BlendOrder::FrontToBack}) {
        Settings settings = bySixteen();
        settings.order = order;
        settings.termination.reset();
        const FramePlan plan = decide(scene, settings);
        const std::vector<ViewTarget> views{eyes(scene, 20.0).front()};
        ASSERT_TRUE(ours.prepare(scene, plan, views).has_value());
        ASSERT_TRUE(ours.draw(scene, plan, views).has_value());
        HostCostCounter counter;
        ASSERT_TRUE(ours.draw(scene, plan, views).has_value());
        EXPECT_LE(counter.take().calls, 40) << counter.listed();
    }
}

// Boxes of so many blocks are found on all cores: by prepare(), which keeps its threads.
TEST_F(HostCostTest, ThreadsBelongToPrepareAndAreKept) {
    const Scene scene = makeScene(ball(130), {.tf = band(60.0)},
                                  {.structure = SkipStructure::Blocks, .blockEdgeVoxels = 1});
    const FramePlan plan = decide(scene, bySixteen());
    ASSERT_TRUE(plan.tighten);
    const std::vector<ViewTarget> views = eyes(scene, 20.0);
    HostCostCounter counter; // after the scene, whose building has started the threads
    ASSERT_TRUE(renderer().prepare(scene, plan, views).has_value());
    EXPECT_EQ(counter.take().threads, 0);
    ASSERT_TRUE(renderer().draw(scene, plan, views).has_value());
    const HostCost draw = counter.take();
    EXPECT_EQ(draw.threads, 0);
    EXPECT_EQ(draw.allocations, 0);
}

TEST_F(HostCostTest, AnEditReusesWhatIsThere) {
    for (const HostState hostState : {HostState::Ours, HostState::Restore}) {
        const gl::StateGuard forOtherTests;
        Result<LiveScene> started = LiveScene::start(makeScene(ball(64), {.tf = band(60.0)}), {});
        ASSERT_TRUE(started.has_value());
        LiveScene& scene = *started;
        Renderer renderer = make(hostState);
        const std::vector<ViewTarget> views = eyes(scene, 20.0);
        // The hand goes to and fro: tables of 118 to 161 texels, the map in use and not.
        for (int frame = 0; frame < 24; ++frame) {
            TransferFunction tf = band(60.0 + (frame % 2 == 0 ? frame : -frame));
            HostCostCounter counter;
            ASSERT_TRUE(scene.edit(std::move(tf)).has_value());
            scene.work(1.0);
            const HostCost edit = counter.take();
            const FramePlan plan = decide(scene, bySixteen());
            counter.take();
            ASSERT_TRUE(renderer.prepare(scene, plan, views).has_value());
            const HostCost prepare = counter.take();
            const std::string listed = counter.listed();
            counter.take();
            ASSERT_TRUE(renderer.draw(scene, plan, views).has_value());
            const HostCost draw = counter.take();
            if (frame < 8) {
                continue; // textures and room are made
            }
            EXPECT_EQ(edit.calls, 0);
            EXPECT_EQ(edit.allocations, 0) << frame << ": " << edit.bytes << " bytes";
            EXPECT_EQ(prepare.allocations, 0) << frame << ": " << prepare.bytes << " bytes";
            EXPECT_EQ(prepare.makes, 0) << listed;
            EXPECT_EQ(prepare.uploads, 1) << listed; // the table, into one that is there
            EXPECT_EQ(prepare.queries, hostState == HostState::Ours ? 0 : 94) << listed;
            EXPECT_EQ(prepare.calls, hostState == HostState::Ours ? 9 : 9 + 188) << listed;
            EXPECT_EQ(draw.allocations, 0) << frame << ": " << draw.bytes << " bytes";
            EXPECT_EQ(edit.threads + prepare.threads + draw.threads, 0);
        }
    }
}

} // namespace slabcast::test

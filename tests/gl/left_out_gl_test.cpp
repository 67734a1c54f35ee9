#include <algorithm>

#include "core/gl/program.h"
#include "perf/stability/left_out_scenes.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

class LeftOutTest : public RenderTest {
protected:
    /// Half of it empty, the other half as visible as `opacity` makes it.
    Scene halfScene(double opacity, const SkipOptions& skip = {}) {
        const Volume volume = makeVolume({32, 32, 32}, VoxelType::U8,
                                         [](glm::ivec3 v) { return v.x < 16 ? 0.0 : 200.0; });
        const TransferFunction tf{
            .points = {{100.0, glm::dvec3(1.0), 0.0}, {100.0, glm::dvec3(1.0), opacity}}};
        return makeScene(volume, {.tf = tf}, skip);
    }
    /// All but the ratio is the plan's choice.
    static Settings open() {
        Settings settings;
        settings.layersPerPlane = 16;
        settings.form = SegmentForm::Loop;
        return settings;
    }
    void prepare(const Scene& scene, const FramePlan& plan) {
        const Result<void> prepared = renderer().prepare(scene, plan, {});
        ASSERT_TRUE(prepared.has_value()) << prepared.error().detail;
    }
    std::vector<std::string> samplersOf(const FramePlan& plan) {
        return renderer().resources(plan.variant).samplers;
    }
};

using Names = std::vector<std::string>;

bool explains(const FramePlan& plan, const std::string& what) {
    const std::vector<ReasonText> reasons = explained(plan);
    return std::any_of(reasons.begin(), reasons.end(),
                       [&](const ReasonText& reason) { return reason.what == what; });
}

TEST_F(LeftOutTest, DriverReportsTheSamplersThatThePlanNeeds) {
    const Scene half = halfScene(0.05);
    const FramePlan skipping = decide(half, open());
    prepare(half, skipping);
    EXPECT_EQ(samplersOf(skipping), (Names{"skipTexels", "transferTable", "volumeTexels"}));
    EXPECT_GT(renderer().gpuMemory().skipBytes, 0);

    const Scene full =
        makeScene(constantVolume({16, 16, 16}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    const FramePlan plain = decide(full, open());
    prepare(full, plain);
    EXPECT_EQ(samplersOf(plain), (Names{"transferTable", "volumeTexels"}));
    EXPECT_EQ(renderer().gpuMemory().skipBytes, 0);
    EXPECT_TRUE(explains(plain, "one material"));
    EXPECT_FALSE(explains(skipping, "one material"));

    const Scene baked =
        makeScene(constantVolume({16, 16, 16}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0)),
                                                    .classification = Classification::Pre});
    Settings settings = open();
    settings.classification = Classification::Pre;
    const FramePlan colors = decide(baked, settings);
    prepare(baked, colors);
    EXPECT_EQ(samplersOf(colors), Names{"volumeTexels"});
}

TEST_F(LeftOutTest, NothingIsKnownOfAProgramThatIsNotThere) {
    renderer().contextLost();
    const gl::ActiveResources none = renderer().resources(ShaderVariant{});
    EXPECT_EQ(none.uniforms, 0);
    EXPECT_TRUE(none.samplers.empty());
}

// An app may keep calling with a TF that hides all: what was there for the last one goes.
TEST_F(LeftOutTest, NothingVisibleKeepsNoTextureAndDrawsNothing) {
    const Scene visible = halfScene(0.05);
    const FramePlan before = decide(visible, open());
    prepare(visible, before);
    EXPECT_GT(renderer().gpuMemory().volumeBytes, 0);
    const std::int64_t other = renderer().gpuMemory().otherBytes;

    const Scene hidden = halfScene(0.0);
    const FramePlan plan = decide(hidden, open());
    ASSERT_TRUE(plan.drawsNothing);
    prepare(hidden, plan);
    EXPECT_EQ(renderer().gpuMemory().volumeBytes, 0);
    EXPECT_EQ(renderer().gpuMemory().skipBytes, 0);
    EXPECT_LT(renderer().gpuMemory().otherBytes, other); // the table
    const glm::vec4 background(0.25F, 0.5F, 0.75F, 1.0F);
    const Picture picture = draw(hidden, plan, asymmetricView(hidden), kSize, background);
    EXPECT_EQ(differingPixels(picture, cleared(plan, kSize, background)), 0);

    prepare(visible, before); // and all is made again
    EXPECT_GT(renderer().gpuMemory().volumeBytes, 0);
    EXPECT_GT(renderer().gpuMemory().skipBytes, 0);
}

TEST_F(LeftOutTest, NoProgramHoldsTextOfWhatItsPlanLeftOut) {
    for (const double opacity : {0.01, 1.0}) {
        const Scene scene = halfScene(opacity);
        const FramePlan plan = decide(scene, open());
        EXPECT_EQ(plan.variant.terminates, opacity == 1.0);
        EXPECT_EQ(stability::textOutOfPlace(plan.variant), 0);
    }
}

// The eye at the centre of a full volume: half of the planes lie behind it, whole boxes reach past
// it to either side.
TEST_F(LeftOutTest, PlanesBehindTheEyeOrTheNearPlaneAreNotDrawn) {
    if (!caps().floatBlend) {
        GTEST_SKIP() << kCannotCount;
    }
    const Scene scene =
        makeScene(constantVolume({32, 32, 32}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    const double radius = scene.geometry().boundingSphere().radiusMm;
    Settings settings = open();
    settings.layersPerPlane = 4;
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        settings.lattice = kind;
        const FramePlan plan = decide(scene, settings);
        ASSERT_TRUE(plan.tighten);
        prepare(scene, plan);
        for (const double nearShare : {0.0, 0.5}) {
            View view = orbitView(scene, {30.0, 20.0, 0.0}, 60.0, kSize);
            view.nearDepth = nearShare * radius;
            const ViewTarget where{view, 0, {0, 0, kSize.x, kSize.y}};
            const Result<WorkCounters> work = renderer().countWork(scene, plan, {&where, 1});
            ASSERT_TRUE(work.has_value());
            // From the one that holds the near plane to the sphere's end.
            const double planes =
                std::floor((1.0 - nearShare) * radius / plan.lattice.spacingMm / 4.0) + 2.0;
            EXPECT_LE(work->fragments, std::int64_t(planes * kSize.x * kSize.y))
                << name(kind) << ", near plane at " << nearShare;
            EXPECT_GT(work->fragments, 0);
        }
    }
}

} // namespace slabcast::test

#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

Volume spikes(glm::ivec3 dims) {
    Random random(7);
    return makeVolume(dims, VoxelType::U8,
                      [&](glm::ivec3) { return random.chance(0.01) ? 200.0 : 3.0; },
                      {1.0, 1.5, 0.8});
}

TransferFunction spikesOnly() {
    return {.points = {{20.0, glm::dvec3(0.2), 0.0}, {255.0, glm::dvec3(1.0), 0.7}}};
}

class GpuSkipTest : public RenderTest {
protected:
    /// Draws plainly, then by the structure as the GPU built it.
    void compare(Classification classification, const SkipOptions& options) {
        const glm::ivec2 size(64, 48);
        const Volume volume = spikes({37, 29, 23});
        const Appearance look{.tf = spikesOnly(), .classification = classification};
        Settings settings = segments(kAll, SegmentForm::Loop);
        settings.classification = classification;
        Scene scene = makeScene(volume, look, {.structure = SkipStructure::None});
        const View view = asymmetricView(scene);
        const Picture plain = draw(scene, settings, view, size);

        const Scene onCpu = makeScene(volume, look, options);
        const Result<void> built = renderer().buildSkip(scene, options);
        ASSERT_TRUE(built.has_value()) << built.error().detail;
        const BuiltSkip& skip = scene.skip();
        EXPECT_EQ(skip.test, onCpu.skip().test);
        EXPECT_EQ(skip.occupiedFraction, onCpu.skip().occupiedFraction);
        ASSERT_EQ(skip.octree != nullptr, onCpu.skip().octree != nullptr);
        EXPECT_TRUE(skip.octree ? *skip.octree == *onCpu.skip().octree
                                : *skip.lengths == *onCpu.skip().lengths);

        settings.skip = options.structure;
        EXPECT_EQ(differingPixels(plain, draw(scene, settings, view, size)), 0);
    }
};

} // namespace

TEST_F(GpuSkipTest, EveryStructureIsTheCpusAndChangesNothing) {
    for (const SkipStructureInfo& info : skipStructures()) {
        if (info.structure != SkipStructure::None) {
            SCOPED_TRACE(info.name);
            compare(Classification::Post, {.structure = info.structure, .bits = 64});
        }
    }
}

TEST_F(GpuSkipTest, PreClassifiedTexelsServeToo) {
    compare(Classification::Pre, {.structure = SkipStructure::Proximity});
    compare(Classification::Pre, {.structure = SkipStructure::BitfieldOctree});
}

TEST_F(GpuSkipTest, PartitionsBeyondTheBudgetAreRefusedAndTheSceneKeepsWhatItHas) {
    Scene scene = makeScene(spikes({37, 29, 23}), {.tf = spikesOnly()});
    const int before = scene.skip().generation;
    const Result<void> built = renderer().buildSkip(
        scene,
        {.structure = SkipStructure::Partitioned, .partitions = 256, .memoryBudgetBytes = 99});
    ASSERT_FALSE(built.has_value());
    EXPECT_EQ(built.error().code, ErrorCode::VolumeTooLarge);
    EXPECT_EQ(scene.skip().generation, before);
}

// A lost context takes the builder's programs and textures with it: all of it can be had again.
TEST_F(GpuSkipTest, BuildsAgainAfterALostContext) {
    Scene scene = makeScene(spikes({16, 16, 16}), {.tf = spikesOnly()});
    ASSERT_TRUE(renderer().buildSkip(scene, {}).has_value());
    renderer().contextLost();
    ASSERT_TRUE(renderer().buildSkip(scene, {}).has_value());
    EXPECT_GT(scene.skip().occupiedFraction, 0.0);
}

} // namespace slabcast::test

#include <algorithm>
#include <cmath>
#include <string>

#include "core/draw/warm_up.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

constexpr glm::ivec2 kSmall(48, 36);
constexpr double kOneItem = 1e-6; // ms: less than any item takes
constexpr double kNoLimit = 1e9;

/// What the driver was given since: textures of voxels or skipping, words of the latter, layers,
/// programs.
struct Calls {
    static inline int volumes = 0, layers = 0, programs = 0;
    static inline std::int64_t wordBytes = 0;
    static inline decltype(gl::TexStorage2D) storage2d = nullptr;
    static inline decltype(gl::TexStorage3D) storage3d = nullptr;
    static inline decltype(gl::TexSubImage3D) subImage3d = nullptr;
    static inline decltype(gl::LinkProgram) link = nullptr;

    Calls() {
        volumes = layers = programs = 0;
        wordBytes = 0;
        storage2d = gl::TexStorage2D;
        storage3d = gl::TexStorage3D;
        subImage3d = gl::TexSubImage3D;
        link = gl::LinkProgram;
        gl::TexStorage2D = [](GLenum target, GLsizei levels, GLenum format, GLsizei w, GLsizei h) {
            layers += h > 1; // tables are rows
            storage2d(target, levels, format, w, h);
        };
        gl::TexStorage3D = [](GLenum target, GLsizei levels, GLenum format, GLsizei w, GLsizei h,
                              GLsizei d) {
            ++volumes;
            storage3d(target, levels, format, w, h, d);
        };
        gl::TexSubImage3D = [](GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei w,
                               GLsizei h, GLsizei d, GLenum format, GLenum type,
                               const void* texels) {
            wordBytes += type == GL_UNSIGNED_INT ? std::int64_t(4) * w * h * d : 0;
            subImage3d(target, level, x, y, z, w, h, d, format, type, texels);
        };
        gl::LinkProgram = [](GLuint program) {
            ++programs;
            link(program);
        };
    }
    ~Calls() {
        gl::TexStorage2D = storage2d;
        gl::TexStorage3D = storage3d;
        gl::TexSubImage3D = subImage3d;
        gl::LinkProgram = link;
    }
    Calls(const Calls&) = delete;
    Calls& operator=(const Calls&) = delete;
};

/// Three balls of different values, softly edged, in air.
Volume balls() {
    return makeVolume({34, 30, 27}, VoxelType::U16, [](glm::ivec3 v) {
        double value = 0.0;
        for (const glm::dvec4 ball : {glm::dvec4(8, 9, 8, 800.0), glm::dvec4(24, 20, 18, 2200.0),
                                      glm::dvec4(10, 22, 19, 3900.0)}) {
            const double depth = 6.0 - glm::distance(glm::dvec3(v), glm::dvec3(ball));
            value = std::max(value, ball.w * std::clamp(depth / 3.0, 0.0, 1.0));
        }
        return value;
    });
}

TransferFunction band(double low, double high, double opacity = 0.4) {
    const glm::dvec3 color(0.9, low / 4095.0, 0.3);
    return {
        .name = "band",
        .points = {{low, color, 0.0}, {(low + high) / 2.0, color, opacity}, {high, color, 0.0}}};
}

const TransferFunction kNothing{.points = {{0.0, glm::dvec3(1.0), 0.0}}};

Settings anySkip() {
    Settings settings;
    settings.layersPerPlane = 16;
    settings.form = SegmentForm::Loop;
    return settings;
}

class LiveEditingTest : public RenderTest {
protected:
    LiveScene edited(const LiveOptions& options,
                     Classification classification = Classification::Post) {
        const SkipOptions skip = options.settled;
        Scene scene = makeScene(
            balls(), {.tf = band(2000.0, 3900.0), .classification = classification}, skip);
        return started(std::move(scene), options);
    }
    static LiveScene started(Scene scene, const LiveOptions& options) {
        Result<LiveScene> live = LiveScene::start(std::move(scene), options);
        EXPECT_TRUE(live.has_value()) << (live ? "" : live.error().detail);
        return std::move(*live);
    }
    FramePlan planOf(const Scene& scene) {
        Settings settings = anySkip();
        settings.classification = scene.provided()->classification;
        return decide(scene, settings);
    }
    Picture draw(const Scene& scene) {
        return RenderTest::draw(scene, planOf(scene), viewOf(scene), kSmall);
    }
    /// The same look, set anew, without any skipping.
    Picture fromScratch(const Scene& scene) {
        Scene fresh = scene;
        const Appearance appearance{.tf = scene.look().tf,
                                    .classification = scene.provided()->classification};
        EXPECT_TRUE(show(fresh, appearance, {.structure = SkipStructure::None}).has_value());
        return draw(fresh);
    }
    View viewOf(const Scene& scene) { return orbitView(scene, {30.0, 15.0, 2.2}, 40.0, kSmall); }

    /// Edits and pauses by chance; every frame is as from scratch. Which structures drew any.
    std::vector<SkipStructure> editAndCompare(const LiveOptions& options,
                                              Classification classification, int frames) {
        Random random(11);
        LiveScene scene = edited(options, classification);
        std::vector<SkipStructure> seen;
        int shown = 0;
        for (int frame = 0; frame < frames; ++frame) {
            if (random.chance(0.35)) {
                const double low = random.in(0.0, 3500.0);
                const TransferFunction tf =
                    random.chance(0.1) ? kNothing : band(low, low + random.in(50.0, 1500.0));
                EXPECT_TRUE(scene.edit(tf).has_value());
            }
            scene.work(random.oneOf({0.0, kOneItem, kOneItem, kNoLimit}));
            const Picture picture = draw(scene);
            EXPECT_EQ(differingPixels(picture, fromScratch(scene)), 0)
                << "frame " << frame << ", " << name(planOf(scene).skip);
            seen.push_back(planOf(scene).skip);
            shown += std::any_of(picture.pixels.begin(), picture.pixels.end(),
                                 [](glm::vec4 p) { return p.a > 0.0F; });
        }
        EXPECT_GT(shown, frames / 4) << "too many pictures were empty to prove anything";
        return seen;
    }
};

bool holds(const std::vector<SkipStructure>& seen, SkipStructure structure) {
    return std::find(seen.begin(), seen.end(), structure) != seen.end();
}

} // namespace

TEST_F(LiveEditingTest, EveryFrameOfEveryHandOverIsAsFromScratch) {
    LiveOptions options{.quietFrames = 1};
    const auto seen = editAndCompare(options, Classification::Post, 60);
    EXPECT_TRUE(holds(seen, SkipStructure::BitfieldOctree));
    EXPECT_TRUE(holds(seen, SkipStructure::Proximity));
}

TEST_F(LiveEditingTest, SoItIsWithAPreintegratedTable) {
    LiveOptions options{.quietFrames = 1};
    options.settled.structure = SkipStructure::Chebyshev;
    const auto seen = editAndCompare(options, Classification::Preintegrated, 30);
    EXPECT_TRUE(holds(seen, SkipStructure::BitfieldOctree));
    EXPECT_TRUE(holds(seen, SkipStructure::Chebyshev));
}

TEST_F(LiveEditingTest, SoItIsWithMergedMaps) {
    LiveOptions options{.quietFrames = 1};
    options.always.structure = SkipStructure::Partitioned;
    options.settled = {.structure = SkipStructure::Blocks, .blockEdgeVoxels = 2};
    const auto seen = editAndCompare(options, Classification::Post, 30);
    EXPECT_TRUE(holds(seen, SkipStructure::Partitioned));
    EXPECT_TRUE(holds(seen, SkipStructure::Blocks));
}

TEST_F(LiveEditingTest, OnlyWhatChangedIsUploaded) {
    // One that is not edited and skips nothing: it lets go of other scenes' maps.
    draw(makeScene(balls(), {.tf = band(2000.0, 3900.0)}, {.structure = SkipStructure::None}));
    LiveScene scene = edited({.quietFrames = 0});
    draw(scene);
    const std::int64_t bytes = renderer().gpuMemory().skipBytes;
    const Calls calls;
    ASSERT_TRUE(scene.edit(band(300.0, 3000.0)).has_value());
    draw(scene);
    EXPECT_EQ(planOf(scene).skip, SkipStructure::BitfieldOctree);
    ASSERT_TRUE(scene.edit(band(2000.0, 3900.0, 0.1)).has_value());
    draw(scene);
    EXPECT_EQ(planOf(scene).skip, SkipStructure::Proximity);
    EXPECT_EQ(Calls::volumes, 0) << "both structures were there";
    ASSERT_TRUE(scene.edit(band(300.0, 3000.0)).has_value());
    EXPECT_EQ(scene.work(kNoLimit), LiveProgress::Swapped);
    draw(scene);
    EXPECT_EQ(Calls::volumes, 1) << "the new map";
    const std::int64_t withSpare = renderer().gpuMemory().skipBytes;
    EXPECT_EQ(withSpare, bytes + gpuBytes(scene.scene().skip()))
        << "the old one is kept for the next";
    ASSERT_TRUE(scene.edit(band(200.0, 3000.0)).has_value());
    EXPECT_EQ(scene.work(kNoLimit), LiveProgress::Swapped);
    draw(scene);
    EXPECT_EQ(renderer().gpuMemory().skipBytes, withSpare) << "in place of the spare one";
    const Scene after = std::move(scene).stop();
    draw(after);
    EXPECT_EQ(renderer().gpuMemory().skipBytes, gpuBytes(after.skip())) << "which then goes";
}

TEST_F(LiveEditingTest, ALargeMapIsUploadedAShareAFrame) {
    const Volume ramp =
        makeVolume({130, 120, 110}, VoxelType::U8, [](glm::ivec3 v) { return v.x; });
    const SkipOptions fine{.blockEdgeVoxels = 1};
    LiveScene scene = started(makeScene(ramp, {.tf = band(20.0, 90.0)}, fine),
                              {.settled = fine, .quietFrames = 0});
    draw(scene);
    ASSERT_TRUE(scene.edit(band(20.0, 120.0)).has_value());
    std::int64_t uploaded = 0;
    int frames = 0;
    for (LiveProgress progress{}; progress != LiveProgress::Swapped; ++frames) {
        ASSERT_LT(frames, 4);
        const Calls calls;
        progress = scene.work(kNoLimit);
        draw(scene);
        EXPECT_EQ(progress == LiveProgress::Swapped,
                  planOf(scene).skip == SkipStructure::Proximity);
        EXPECT_LE(Calls::wordBytes, kUploadBytesPerFrame);
        uploaded += Calls::wordBytes;
    }
    EXPECT_EQ(frames, 2);
    EXPECT_EQ(uploaded, gpuBytes(scene.scene().skip()));
    const Picture picture = draw(scene);
    EXPECT_EQ(differingPixels(picture, fromScratch(scene)), 0);
}

TEST_F(LiveEditingTest, ATransferFunctionThatShowsNothingKeepsTheTextures) {
    LiveScene scene = edited({});
    draw(scene);
    const std::int64_t volumeBytes = renderer().gpuMemory().volumeBytes;
    const Calls calls;
    ASSERT_TRUE(scene.edit(kNothing).has_value());
    EXPECT_TRUE(planOf(scene).drawsNothing);
    draw(scene);
    EXPECT_EQ(renderer().gpuMemory().volumeBytes, volumeBytes);
    ASSERT_TRUE(scene.edit(band(300.0, 3000.0)).has_value());
    draw(scene);
    EXPECT_EQ(Calls::volumes, 0);
}

TEST_F(LiveEditingTest, AfterWarmingUpNothingIsCompiledNorAllocated) {
    LiveScene scene = started(makeScene(balls(), {.tf = band(2000.0, 3900.0)},
                                        {.structure = SkipStructure::None}), // yet to be built
                              {.quietFrames = 0});
    Result<Renderer> own = Renderer::create(device());
    ASSERT_TRUE(own.has_value());
    gl::ColorTargets target;
    ASSERT_TRUE(target.resize(kSmall.x, kSmall.y, {GL_RGBA8}).has_value());
    const ViewTarget where{viewOf(scene), target.framebuffer(), {0, 0, kSmall.x, kSmall.y}};
    const Result<void> warm = warmUpForEditing(*own, scene, anySkip(), caps(), {}, {&where, 1});
    ASSERT_TRUE(warm.has_value()) << warm.error().detail;
    const auto frame = [&] {
        const FramePlan plan = planOf(scene);
        EXPECT_TRUE(own->prepare(scene, plan, {&where, 1}).has_value());
        EXPECT_TRUE(own->draw(scene, plan, {&where, 1}).has_value());
        return plan;
    };
    ASSERT_TRUE(own->prepare(scene, planOf(scene), {&where, 1}).has_value());
    const Calls calls;
    std::vector<std::string> variants;
    double low = 1000.0; // ever more is shown: no map serves before it is rebuilt
    for (const double opacity : {1e-6, 1e-3, 0.1, 0.7, 0.99, 1.0}) {
        ASSERT_TRUE(scene.edit(band(low -= 100.0, 3000.0, opacity)).has_value());
        variants.push_back(name(frame().variant));
        EXPECT_EQ(scene.work(kNoLimit), LiveProgress::Swapped);
        variants.push_back(name(frame().variant));
    }
    EXPECT_EQ(Calls::programs, 0);
    EXPECT_EQ(Calls::volumes, 0);
    EXPECT_EQ(Calls::layers, 0);
    std::sort(variants.begin(), variants.end());
    const auto different = std::unique(variants.begin(), variants.end()) - variants.begin();
    EXPECT_GE(different, 4) << "both structures, with and without termination";
}

TEST_F(LiveEditingTest, PreclassifiedTexelsAreRefused) {
    const Result<LiveScene> live = LiveScene::start(makeScene(
        balls(), {.tf = band(2000.0, 3900.0), .classification = Classification::Pre}, {}));
    ASSERT_FALSE(live.has_value());
    EXPECT_EQ(live.error().code, ErrorCode::InvalidArgument);
}

TEST_F(LiveEditingTest, AnInvalidTransferFunctionChangesNothing) {
    LiveScene scene = edited({});
    const int look = scene.scene().lookGeneration();
    const Result<void> done = scene.edit({.points = {{5.0, glm::dvec3(1.0), 2.0}}});
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, ErrorCode::InvalidTransferFunction);
    EXPECT_EQ(scene.scene().lookGeneration(), look);
    EXPECT_EQ(scene.scene().look().tf.points.size(), 3U);
}

TEST_F(LiveEditingTest, WhoStopsKeepsWhatSkipsNow) {
    LiveScene scene = edited({});
    ASSERT_TRUE(scene.edit(band(300.0, 3000.0)).has_value());
    const Picture picture = draw(scene);
    const std::int64_t bytes = renderer().gpuMemory().skipBytes;
    const Scene after = std::move(scene).stop();
    EXPECT_EQ(after.live(), nullptr);
    EXPECT_EQ(after.skip().options.structure, SkipStructure::BitfieldOctree);
    EXPECT_EQ(differingPixels(picture, draw(after)), 0);
    EXPECT_LT(renderer().gpuMemory().skipBytes, bytes) << "the map is gone";
}

TEST_F(LiveEditingTest, ACopyHasALookOfItsOwn) {
    LiveScene scene = edited({});
    LiveScene copy = scene;
    ASSERT_TRUE(copy.edit(band(300.0, 3000.0)).has_value());
    EXPECT_EQ(scene.scene().skip().options.structure, SkipStructure::Proximity);
    EXPECT_EQ(differingPixels(draw(scene), fromScratch(scene)), 0);
    EXPECT_EQ(differingPixels(draw(copy), fromScratch(copy)), 0);
    EXPECT_EQ(scene.scene().texelsGeneration(), copy.scene().texelsGeneration())
        << "one texture for both";
}

// It shares the structures of what is edited, which know that one's TF alone: here they are of one
// that shows nothing, so that all of the copy would be skipped.
TEST_F(LiveEditingTest, ACopyUnderAnotherLookIsNotEdited) {
    LiveScene scene = edited({});
    ASSERT_TRUE(scene.edit(kNothing).has_value());
    Scene copy = scene;
    ASSERT_TRUE(show(copy, {.tf = band(300.0, 3000.0)}, noSkip().options).has_value());
    EXPECT_EQ(copy.live(), nullptr);
    EXPECT_EQ(copy.skip().options.structure, SkipStructure::None);
    const Picture picture = draw(copy);
    EXPECT_TRUE(std::any_of(picture.pixels.begin(), picture.pixels.end(),
                            [](glm::vec4 p) { return p.a > 0.0F; }));
    Scene alone = makeScene(balls(), {.tf = band(300.0, 3000.0)}, noSkip().options);
    EXPECT_EQ(differingPixels(picture, draw(alone)), 0);

    EXPECT_NE(scene.scene().live(), nullptr) << "what it was copied from is edited on";
    ASSERT_TRUE(scene.edit(band(500.0, 2500.0)).has_value());
    EXPECT_EQ(differingPixels(draw(scene), fromScratch(scene)), 0);
}

} // namespace slabcast::test

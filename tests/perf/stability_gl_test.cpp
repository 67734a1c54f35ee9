#include <algorithm>
#include <cmath>
#include <utility>

#include "perf/stability/bench.h"
#include "perf/stability/conditions.h"
#include "perf/stability/expected.h"
#include "perf/stability/phone_cost.h"
#include "perf/stability/volumes.h"
#include "tests/support/render_support.h"

namespace slabcast::stability {
namespace {

constexpr glm::ivec2 kSize(16, 16);

class StabilityTest : public test::RenderTest {
protected:
    Bench bench() { return {renderer(), device(), true}; }

    /// 8 mm of one material, of which 1 mm lets 0.7 through.
    static Volume box() {
        return formulaVolume({8, 8, 8}, VoxelType::U8, [](glm::ivec3) { return 100.0; });
    }
    static Appearance look() { return {.tf = uniformTransfer(0.3, glm::dvec3(1.0))}; }
};

TEST(Verdict, IsGoodWhereEveryCaseKeepsItsBound) {
    EXPECT_TRUE(verdict({}).has_value());
    const Case kept[] = {{.name = "at it", .bound = 1.0, .measured = 1.0},
                         {.name = "below", .bound = 1.0, .measured = 0.5}};
    EXPECT_TRUE(verdict(kept).has_value());
}

TEST(Verdict, CountsAndNamesWhatExceedsItsBound) {
    const Case cases[] = {{.name = "kept", .bound = 1.0, .measured = 1.0},
                          {.name = "above", .bound = 1.0, .measured = std::nextafter(1.0, 2.0)},
                          {.name = "not a number", .bound = 1.0, .measured = std::nan("")},
                          {.name = "not drawn", .bound = 1.0, .failure = "no memory"}};
    const Result<void> result = verdict(cases);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::Internal);
    EXPECT_NE(result.error().detail.find("3 of 4 cases"), std::string::npos);
    EXPECT_NE(result.error().detail.find("'above'"), std::string::npos) << result.error().detail;
}

TEST(CaseNames, LeaveOutEmptyParts) {
    EXPECT_EQ(named({"a", "", "b"}), "a, b");
    EXPECT_EQ(named({"", "b"}), "b");
}

TEST_F(StabilityTest, WhatIsDrawnAndExceedsItsBoundIsAFailedCase) {
    Bench bench = this->bench();
    const Result<Scene> scene = bench.scene(box(), look(), {.structure = SkipStructure::None});
    ASSERT_TRUE(scene.has_value()) << scene.error().detail;
    const View view = distantView(*scene, 0.0, 2.0, kSize);
    int heard = 0;
    bench.setWatcher([&](const Case&) { ++heard; });
    // 1 - 0.7^8: a claim that holds, and one, of nothing to be seen, that does not.
    for (const double alpha : {1.0 - std::pow(0.7, 8.0), 0.0}) {
        bench.examine({.name = "alpha of " + number(alpha), .bound = 2e-3}, *scene,
                      settingsOf(methods()[5]), view, kSize, [&](Case& c, const Drawn& drawn) {
                          const std::vector<glm::dvec4> meant(drawn.picture.pixels.size(),
                                                              glm::dvec4(alpha));
                          c.measured = largestDifference(drawn.picture, meant);
                      });
    }
    EXPECT_EQ(heard, 2);
    ASSERT_EQ(bench.cases().size(), 2U);
    EXPECT_TRUE(bench.cases()[0].pass()) << bench.cases()[0].measured;
    EXPECT_FALSE(bench.cases()[1].pass()) << bench.cases()[1].measured;
    const Result<void> result = verdict(bench.cases());
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().detail.find("'alpha of 0'"), std::string::npos);
}

TEST_F(StabilityTest, WhatCannotBeDrawnIsAFailedCaseWithItsReason) {
    Bench bench = this->bench();
    const Result<Scene> scene = bench.scene(box(), look(), {.structure = SkipStructure::None});
    ASSERT_TRUE(scene.has_value()) << scene.error().detail;
    Settings contradictory = settingsOf(methods()[0]);
    contradictory.planes = 2;
    bench.examine({.name = "never", .bound = 1.0}, *scene, contradictory,
                  distantView(*scene, 0.0, 2.0, kSize), kSize,
                  [](Case&, const Drawn&) { ADD_FAILURE() << "judged without a picture"; });
    ASSERT_EQ(bench.cases().size(), 1U);
    EXPECT_FALSE(bench.cases()[0].pass());
    EXPECT_NE(bench.cases()[0].failure.find("both set"), std::string::npos);
}

TEST_F(StabilityTest, ABoundThatNoPictureCouldExceedIsAFailedCase) {
    Bench bench = this->bench();
    const char* const ofFullScale = "largest difference, of full scale";
    bench.record({.name = "could", .quantity = ofFullScale, .bound = 0.99});
    bench.record({.name = "could not", .quantity = ofFullScale, .bound = 1.0});
    bench.record({.name = "has no scale", .quantity = "layers", .bound = 1.0});
    EXPECT_TRUE(bench.cases()[0].pass());
    EXPECT_FALSE(bench.cases()[1].pass());
    EXPECT_TRUE(bench.cases()[2].pass());
}

/// Names are unique by contract, those of failures included: this would abort otherwise.
TEST_F(StabilityTest, OnADeviceThatCannotDrawEveryFamilyEndsInFailedCases) {
    const auto real = std::exchange(gl::CheckFramebufferStatus,
                                    [](GLenum) { return GLenum{GL_FRAMEBUFFER_UNSUPPORTED}; });
    Bench bench = this->bench();
    for (const Family& family : families()) {
        const std::size_t before = bench.cases().size();
        family.run(bench);
        const auto failed =
            std::count_if(bench.cases().begin() + std::ptrdiff_t(before), bench.cases().end(),
                          [](const Case& c) { return !c.failure.empty(); });
        EXPECT_GT(failed, 0) << family.name;
    }
    gl::CheckFramebufferStatus = real;
}

/// A box of 8 layers, seen as a picture that it fills in part: one fragment for all of a ray, or
/// one for each layer, which a phone's model makes dearer.
TEST_F(StabilityTest, APhonesModelCountsFragmentsAndLayers) {
    Bench bench = this->bench();
    if (!bench.caps().floatBlend) {
        GTEST_SKIP() << test::kCannotCount;
    }
    const Result<Scene> scene = bench.scene(box(), look(), {.structure = SkipStructure::None});
    ASSERT_TRUE(scene.has_value()) << scene.error().detail;
    const View view = distantView(*scene, 0.0, 2.0, kSize);
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        FrameWork works[2];
        double ms[2] = {};
        for (const int k : {0, 1}) {
            Settings settings = settingsOf(methods()[k]); // slices, and 16 layers a plane
            settings.lattice = kind;
            settings.form = SegmentForm::Unrolled;
            const Result<FrameWork> work = workOfMillion(bench, *scene, settings, view, 0.5);
            ASSERT_TRUE(work.has_value()) << work.error().detail;
            const auto terms = modelledOn(*findGpuRates("g71"), bench, *scene, settings, *work);
            ASSERT_TRUE(terms.has_value() && terms->has_value());
            works[k] = *work;
            ms[k] = (*terms)->frameMs;
        }
        EXPECT_EQ(works[0].pixels, 1e6);
        EXPECT_EQ(works[0].rays, 0.5e6);
        EXPECT_GT(works[0].fragments, 8.0 * works[1].fragments);
        EXPECT_GT(works[0].layers, 0.0);
        EXPECT_GT(ms[0], ms[1]) << name(kind); // by how much is the committed costs' matter
    }
}

TEST_F(StabilityTest, APixelsOwnBoundTellsPicturesOfDifferentViewsApart) {
    Bench bench = this->bench();
    const Volume ramp =
        formulaVolume({16, 16, 16}, VoxelType::U8, [](glm::ivec3 v) { return 16.0 * v.x; });
    const Appearance rising{
        .tf = {.points = {{0.0, glm::dvec3(1.0), 0.0}, {255.0, glm::dvec3(1.0), 0.3}}}};
    const Result<Scene> scene = bench.scene(ramp, rising, {.structure = SkipStructure::None});
    ASSERT_TRUE(scene.has_value()) << scene.error().detail;
    const View view = distantView(*scene, 0.0, 6.0, kSize);
    const Result<Drawn> drawn = bench.draw(*scene, settingsOf(methods()[5]), view, kSize);
    ASSERT_TRUE(drawn.has_value()) << drawn.error().detail;
    EXPECT_LE(shareOfPixelBound(*scene, *drawn, view), 1.0);
    EXPECT_GT(shareOfPixelBound(*scene, *drawn, distantView(*scene, 180.0, 6.0, kSize)), 1.0);
}

} // namespace
} // namespace slabcast::stability

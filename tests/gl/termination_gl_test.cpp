#include <algorithm>
#include <cmath>
#include <string>

#include "core/gl/state_guard.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

constexpr double kOpacity = 0.99; // of termination

/// Planes nearest first: how they are left out behind opaque material.
enum class Way { Marks, Fetch };

/// Half a step of a target below 1: how far a stored alpha may be from what was gathered.
double halfStep(TargetFormat target) {
    return target == TargetFormat::Rgba8 ? 1.0 / 510.0 : 0x1p-12;
}

/// What may be lost behind a pixel that is left.
double lostBehind(TargetFormat target) {
    return 1.0 - kOpacity + halfStep(target);
}

/// Front to back, a plane's rounding of colour stays, and that of alpha weighs whatever colour is
/// behind, which sums up to 1 at most: each plane's counts twice.
double underBlendingBound(const FramePlan& plan) {
    return roundingOfDeepest(plan.target) + 2.0 * plan.planes * roundingPerPlane(plan.target);
}

/// A ball of many values, hard at its rim. Up to `mostOpacity` per mm; the back is of another
/// colour than the front, so that what is wrongly before shows.
Volume ball() {
    return makeVolume({32, 32, 32}, VoxelType::U8, [](glm::ivec3 v) {
        const double inside = 12.0 - glm::distance(glm::dvec3(v), glm::dvec3(15.5, 17.0, 14.0));
        return inside < 0.0 ? 0.0 : std::min(120.0 + 4.0 * v.y, 255.0);
    });
}

TransferFunction ballTransfer(double opacity, bool white) {
    const glm::dvec3 back = white ? glm::dvec3(1.0) : glm::dvec3(0.1, 0.2, 1.0);
    const glm::dvec3 front = white ? glm::dvec3(1.0) : glm::dvec3(1.0, 0.7, 0.1);
    return {.points = {{80.0, front, 0.0}, {150.0, front, opacity}, {250.0, back, opacity}}};
}

class TerminationTest : public RenderTest {
protected:
    Scene ballScene(double opacity, bool white = false, const SkipOptions& skip = {}) {
        return makeScene(ball(), {.tf = ballTransfer(opacity, white)}, skip);
    }
    bool can(Way way) const { return way == Way::Marks || caps().framebufferFetch; }

    /// As the plan would be on a device with or without the extension; `planesPerMark` of marks, 0
    /// as decided.
    FramePlan frontToBack(const Scene& scene, Settings settings, Way way, int planesPerMark = 0) {
        gl::Caps device = caps();
        device.framebufferFetch = way == Way::Fetch;
        device.isSoftware = false; // which would have marks for short segments
        settings.order = BlendOrder::FrontToBack;
        settings.termination = kOpacity;
        Result<FramePlan> made = plan(scene.facts(), settings, device, {});
        EXPECT_TRUE(made.has_value());
        EXPECT_EQ(made->variant.fetchesTarget, way == Way::Fetch && made->planes > 1);
        if (way == Way::Marks && planesPerMark > 0) {
            made->planesPerMark = planesPerMark;
            made->terminationAlpha = kOpacity;
        }
        return *made;
    }
    FramePlan unterminated(const Scene& scene, Settings settings, BlendOrder order) {
        settings.order = order;
        settings.termination.reset();
        return decide(scene, settings);
    }
    std::vector<PixelWork> work(const Scene& scene, const FramePlan& plan, const View& view,
                                glm::ivec2 size) {
        EXPECT_TRUE(renderer().prepare(scene, plan, {}).has_value());
        const Result<std::vector<PixelWork>> counted =
            renderer().workPerPixel(scene, plan, {view, 0, {0, 0, size.x, size.y}});
        EXPECT_TRUE(counted.has_value());
        return counted.value_or(std::vector<PixelWork>{});
    }
    WorkCounters total(const Scene& scene, const FramePlan& plan, const View& view) {
        WorkCounters sum;
        for (const PixelWork& pixel : work(scene, plan, view, kSize)) {
            sum += pixel;
        }
        return sum;
    }
};

std::string describe(const FramePlan& plan) {
    return name(plan.variant) + ", " + std::to_string(plan.planes) + "x" +
           std::to_string(plan.layersPerPlane) + ", " + name(plan.lattice.kind) + ", " +
           name(plan.target) + (plan.tighten ? ", tight" : "") + ", marks every " +
           std::to_string(plan.planesPerMark);
}

/// Ratios and targets whose rounding leaves room to see what is wrong.
std::vector<Settings> manySettings() {
    std::vector<Settings> all;
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const bool tighten : {false, true}) {
            for (const int layers : {1, 4, 16}) {
                Settings s =
                    segments(layers, layers == 4 ? SegmentForm::Unrolled : SegmentForm::Loop);
                s.lattice = lattice;
                s.tighten = tighten;
                all.push_back(s);
                s.target = TargetFormat::Rgba8;
                if (layers == 16) {
                    all.push_back(s);
                }
            }
        }
    }
    return all;
}

constexpr const char* kCannotFetch = "a fragment cannot read what is blended under it here";

class EachWay : public TerminationTest, public ::testing::WithParamInterface<Way> {
protected:
    void SetUp() override {
        TerminationTest::SetUp();
        if (!IsSkipped() && !can(GetParam())) {
            GTEST_SKIP() << kCannotFetch;
        }
    }
};

INSTANTIATE_TEST_SUITE_P(Ways, EachWay, ::testing::Values(Way::Marks, Way::Fetch),
                         [](const auto& info) {
                             return info.param == Way::Marks ? "Marks" : "Fetch";
                         });

} // namespace

// Opaque and translucent, from outside and from within: the picture of planes over each other with
// every layer drawn, but for what termination may lose and both orders' rounding.
TEST_P(EachWay, IsThePictureOfTheOtherOrderWithinTheThreshold) {
    for (const double opacity : {0.05, 0.9}) {
        const Scene scene = ballScene(opacity);
        const View views[] = {asymmetricView(scene),
                              orbitView(scene, {200.0, -20.0, 0.4}, 80.0, kSize)};
        for (const View& view : views) {
            for (const Settings& settings : manySettings()) {
                const FramePlan over = unterminated(scene, settings, BlendOrder::BackToFront);
                const Picture expected = draw(scene, over, view, kSize);
                const FramePlan under = frontToBack(scene, settings, GetParam(), 2);
                EXPECT_LE(largestDifference(draw(scene, under, view, kSize), expected),
                          lostBehind(under.target) + blendingBound(over) +
                              underBlendingBound(under))
                    << describe(under) << ", opacity " << opacity;
            }
        }
    }
}

// Where colour is white it is alpha, which grows from plane to plane and not beyond 1: a pixel that
// is left lacks what is behind it and no rounding, one that is not left is the same to the bit.
TEST_F(TerminationTest, AMarkedPixelLacksWhatIsBehindItAndOthersNothing) {
    const Scene scene = ballScene(0.6, true);
    const View view = asymmetricView(scene);
    for (const Settings& settings : manySettings()) {
        const FramePlan all = unterminated(scene, settings, BlendOrder::FrontToBack);
        const Picture whole = draw(scene, all, view, kSize);
        for (const int k : {1, 2, 3, 7, all.planes - 1, all.planes}) {
            // In segments nothing is left here: marks alone.
            FramePlan marked = frontToBack(scene, settings, Way::Marks, k);
            marked.variant.terminates = false;
            const Picture picture = draw(scene, marked, view, kSize);
            double most = 0.0;
            int changed = 0;
            for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
                const glm::vec4 lacks = whole.pixels[i] - picture.pixels[i];
                if (double(whole.pixels[i].a) <= saturatedAlpha(marked)) {
                    EXPECT_EQ(lacks, glm::vec4(0.0F)) << describe(marked);
                }
                EXPECT_GE(std::min({lacks.r, lacks.g, lacks.b, lacks.a}), 0.0F);
                most = std::max(most, double(std::max({lacks.r, lacks.g, lacks.b, lacks.a})));
                changed += lacks != glm::vec4(0.0F);
            }
            EXPECT_LE(most, 1.0 - saturatedAlpha(marked)) << describe(marked);
            if (k == 1) {
                EXPECT_GT(changed, 0) << describe(marked);
            } else if (k == all.planes) {
                EXPECT_EQ(changed, 0) << describe(marked);
            }
        }
    }
}

// A cube seen along an axis, half of the light left after each layer: 0.99 is passed by the 7th
// layer (1 - 2^-7 = 0.992). The box begins where the 10th layer does.
TEST_F(TerminationTest, LeavesARayWhereTheClosedFormSays) {
    if (!caps().floatBlend) {
        GTEST_SKIP() << kCannotCount;
    }
    const Scene scene = makeScene(constantVolume({24, 24, 24}, 5),
                                  {.tf = uniformTransfer(std::log(2.0), glm::dvec3(1.0))});
    Settings settings = segments(1, SegmentForm::Loop);
    settings.tighten = false;
    const glm::ivec2 size(9, 9);
    const View view = orbitView(scene, {0.0, 0.0, 40.0}, 3.0, size);
    const std::size_t middle = 4 * 9 + 4;
    const FramePlan all = unterminated(scene, settings, BlendOrder::FrontToBack);
    ASSERT_EQ(all.planes, 42);
    const PixelWork whole = work(scene, all, view, size)[middle];
    EXPECT_EQ(whole.fragments, 42.0F);
    // The box ends on layers' ends, and is wider by the rounding of a coordinate: next to nothing of
    // a layer more at either end.
    EXPECT_EQ(whole.layersEvaluated, 26.0F);
    for (const int k : {1, 2, 3, 5, 8, 16, 20, 41, 42}) {
        const int drawn = std::min(42, (9 + 7 + k - 1) / k * k); // up to the next mark
        const FramePlan marked = frontToBack(scene, settings, Way::Marks, k);
        const PixelWork pixel = work(scene, marked, view, size)[middle];
        EXPECT_EQ(pixel.fragments, float(drawn)) << k;
        EXPECT_EQ(pixel.layersEvaluated, float(std::min(26, drawn - 8))) << k;
    }
    if (!can(Way::Fetch)) {
        GTEST_SKIP() << kCannotFetch;
    }
    const FramePlan fetching = frontToBack(scene, settings, Way::Fetch);
    const PixelWork pixel = work(scene, fetching, view, size)[middle];
    EXPECT_EQ(pixel.fragments, 42.0F);
    EXPECT_EQ(pixel.layersEvaluated, 8.0F);
    settings.layersPerPlane = 5; // after the fourth plane, in groups of eight that hold five
    const FramePlan hybrid = frontToBack(scene, settings, Way::Fetch);
    EXPECT_EQ(work(scene, hybrid, view, size)[middle].layersEvaluated, 24.0F);
}

TEST_F(TerminationTest, SavesWorkOnlyWhereItIsOnAndSomethingIsOpaque) {
    if (!caps().floatBlend) {
        GTEST_SKIP() << kCannotCount;
    }
    for (const double opacity : {0.01, 0.9}) {
        const Scene scene = ballScene(opacity);
        const View view = asymmetricView(scene);
        for (const int layers : {1, 4}) {
            const Settings settings = segments(layers, SegmentForm::Loop);
            const WorkCounters over =
                total(scene, unterminated(scene, settings, BlendOrder::BackToFront), view);
            const WorkCounters off =
                total(scene, unterminated(scene, settings, BlendOrder::FrontToBack), view);
            EXPECT_EQ(off.fragments, over.fragments);
            EXPECT_EQ(off.layersEvaluated, over.layersEvaluated);
            const bool saves = opacity > 0.5;
            std::int64_t before = 0;
            for (const int k : {1, 2, 4, 8}) { // the marks of each are among those of the last
                const WorkCounters on =
                    total(scene, frontToBack(scene, settings, Way::Marks, k), view);
                EXPECT_GE(on.fragments, before) << k;
                EXPECT_EQ(on.fragments < over.fragments, saves) << k;
                EXPECT_EQ(on.layersEvaluated < over.layersEvaluated, saves) << k;
                before = on.fragments;
            }
        }
    }
}

TEST_F(TerminationTest, FetchingSavesLayersAndNoFragments) {
    if (!caps().floatBlend || !can(Way::Fetch)) {
        GTEST_SKIP() << (caps().floatBlend ? kCannotFetch : kCannotCount);
    }
    for (const double opacity : {0.01, 0.9}) {
        const Scene scene = ballScene(opacity);
        const View view = asymmetricView(scene);
        for (const int layers : {1, 4}) {
            const Settings settings = segments(layers, SegmentForm::Loop);
            const WorkCounters over =
                total(scene, unterminated(scene, settings, BlendOrder::BackToFront), view);
            const WorkCounters on = total(scene, frontToBack(scene, settings, Way::Fetch), view);
            EXPECT_EQ(on.fragments, over.fragments);
            const bool saves = opacity > 0.5;
            EXPECT_EQ(on.layersEvaluated < over.layersEvaluated, saves);
        }
    }
}

// Marks lie at the lattice's planes, not at those of a stack: what is skipped or tightened away
// moves none.
TEST_P(EachWay, SkippingChangesNothing) {
    for (const SkipStructure structure : {SkipStructure::Proximity, SkipStructure::Blocks}) {
        const Scene scene = ballScene(0.7, false, {.structure = structure, .blockEdgeVoxels = 2});
        const View view = asymmetricView(scene);
        for (const int layers : {1, 3, 16}) {
            for (const TargetFormat target : {TargetFormat::Rgba8, TargetFormat::Rgba16f}) {
                Settings settings = segments(layers, SegmentForm::Loop);
                settings.target = target;
                settings.tighten = false;
                const Picture plain =
                    draw(scene, frontToBack(scene, settings, GetParam(), 3), view, kSize);
                for (const bool tighten : {false, true}) {
                    for (const bool skips : {false, true}) {
                        settings.tighten = tighten;
                        settings.skip = skips ? structure : SkipStructure::None;
                        const FramePlan plan = frontToBack(scene, settings, GetParam(), 3);
                        EXPECT_EQ(differingPixels(plain, draw(scene, plan, view, kSize)), 0)
                            << describe(plan);
                    }
                }
            }
        }
    }
}

TEST_P(EachWay, EachEyeIsItsMonoPictureAndViewsShareTheLayer) {
    constexpr glm::ivec2 eye(60, 48);
    const Scene scene = ballScene(0.8);
    const auto eyes = stereoViews(orbitView(scene, {20.0, 15.0, 2.2}, 50.0, eye), 8.0,
                                  2.2 * scene.geometry().boundingSphere().radiusMm);
    const FramePlan plan = frontToBack(scene, segments(2, SegmentForm::Loop), GetParam(), 3);
    const Picture mono[] = {draw(scene, plan, eyes[0], eye), draw(scene, plan, eyes[1], eye)};
    gl::ColorTargets wide;
    ASSERT_TRUE(wide.resize(2 * eye.x, eye.y, {GL_RGBA16F}).has_value());
    wide.begin();
    const Viewport places[] = {{0, 0, eye.x, eye.y}, {eye.x, 0, eye.x, eye.y}};
    const ViewTarget both[] = {{eyes[0], wide.framebuffer(), places[0]},
                               {eyes[1], wide.framebuffer(), places[1]}};
    ASSERT_TRUE(renderer().prepare(scene, plan, both).has_value());
    ASSERT_TRUE(renderer().draw(scene, plan, both).has_value());
    const Picture picture{{2 * eye.x, eye.y}, wide.read()};
    EXPECT_GT(differingPixels(mono[0], mono[1]), 300);
    for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(differingPixels(picture.part(places[k]), mono[k]), 0) << describe(plan);
    }
}

// The layer is put over the target once, in the target's space.
TEST_F(TerminationTest, CompositesOverWhatIsThere) {
    const glm::vec4 background(0.25F, 0.5F, 0.75F, 1.0F);
    for (const CompositingSpace space : {CompositingSpace::Display, CompositingSpace::Linear}) {
        const Scene scene = makeScene(ball(), {.tf = ballTransfer(0.3, false), .space = space});
        const View view = asymmetricView(scene);
        Settings settings = segments(4, SegmentForm::Loop);
        settings.space = space;
        const FramePlan plan = frontToBack(scene, settings, Way::Marks, 2);
        const Picture alone = draw(scene, plan, view, kSize);
        const Picture over = draw(scene, plan, view, kSize, background);
        double worst = 0.0;
        for (std::size_t i = 0; i < alone.pixels.size(); ++i) {
            const glm::vec4 expected = alone.pixels[i] + (1.0F - alone.pixels[i].a) * background;
            const glm::vec4 off = glm::abs(over.pixels[i] - expected);
            worst = std::max({worst, double(off.x), double(off.y), double(off.z), double(off.w)});
        }
        EXPECT_LE(worst, 2.0 * roundingPerPlane(plan.target));
    }
}

// Sizes that grow and shrink, marks that come and go, a context that is lost: the same picture, and
// memory for depth only where there are marks.
TEST_F(TerminationTest, LayerFollowsSizeAndPlan) {
    const Scene scene = ballScene(0.8);
    const View view = asymmetricView(scene);
    const Settings settings = segments(2, SegmentForm::Loop);
    const FramePlan marked = frontToBack(scene, settings, Way::Marks, 3);
    const FramePlan plain = unterminated(scene, settings, BlendOrder::FrontToBack);
    renderer().contextLost();
    const std::int64_t pixels = std::int64_t(kSize.x) * kSize.y;
    const Picture first = draw(scene, marked, view, kSize);
    const std::int64_t withDepth = renderer().gpuMemory().otherBytes;
    const Picture withoutMarks = draw(scene, plain, view, kSize);
    EXPECT_EQ(withDepth - renderer().gpuMemory().otherBytes, 2 * pixels);
    EXPECT_EQ(differingPixels(first, draw(scene, marked, view, kSize)), 0);
    EXPECT_EQ(renderer().gpuMemory().otherBytes, withDepth);
    const glm::ivec2 large = 2 * kSize;
    const Picture wide = draw(scene, marked, view, large);
    EXPECT_EQ(differingPixels(first, draw(scene, marked, view, kSize)), 0);
    renderer().contextLost();
    EXPECT_EQ(differingPixels(wide, draw(scene, marked, view, large)), 0);
    EXPECT_EQ(differingPixels(withoutMarks, draw(scene, plain, view, kSize)), 0);
    renderer().contextLost();
}

// A host that tests depth its own way round, with an offset and a reversed range.
TEST_F(TerminationTest, HostsDepthStateStaysAndMovesNoMark) {
    const Scene scene = ballScene(0.8);
    const View view = asymmetricView(scene);
    const FramePlan plan = frontToBack(scene, segments(1, SegmentForm::Loop), Way::Marks, 3);
    const Picture expected = draw(scene, plan, view, kSize);
    const gl::StateGuard forOtherTests;
    gl::ColorTargets target;
    ASSERT_TRUE(target.resize(kSize.x, kSize.y, {GL_RGBA16F, GL_DEPTH_COMPONENT16}).has_value());
    target.begin();
    gl::Enable(GL_DEPTH_TEST);
    gl::Enable(GL_POLYGON_OFFSET_FILL);
    gl::DepthFunc(GL_GREATER);
    gl::DepthRangef(1.0F, 0.0F);
    gl::DepthMask(GL_TRUE);
    const ViewTarget where{view, target.framebuffer(), {0, 0, kSize.x, kSize.y}};
    ASSERT_TRUE(renderer().draw(scene, plan, {&where, 1}).has_value());
    EXPECT_EQ(differingPixels(expected, {kSize, target.read()}), 0);
    GLint function = 0;
    GLfloat range[2] = {};
    gl::GetIntegerv(GL_DEPTH_FUNC, &function);
    gl::GetFloatv(GL_DEPTH_RANGE, range);
    EXPECT_EQ(function, GL_GREATER);
    EXPECT_EQ(range[0], 1.0F);
    EXPECT_EQ(range[1], 0.0F);
    EXPECT_TRUE(gl::IsEnabled(GL_DEPTH_TEST) && gl::IsEnabled(GL_POLYGON_OFFSET_FILL));
}

TEST_F(TerminationTest, TheExtensionDecidesTheWay) {
    const Scene scene = ballScene(0.9);
    Settings settings = segments(8, SegmentForm::Loop);
    settings.termination = kOpacity;
    settings.order = BlendOrder::FrontToBack;
    const FramePlan plan = decide(scene, settings);
    EXPECT_EQ(plan.variant.fetchesTarget, caps().framebufferFetch);
    EXPECT_EQ(plan.planesPerMark == 0, caps().framebufferFetch);
    EXPECT_EQ(name(plan.variant).find("+fetch") != std::string::npos, caps().framebufferFetch);
}

} // namespace slabcast::test

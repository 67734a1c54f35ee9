#include <algorithm>
#include <cmath>

#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

class RendererTest : public RenderTest {};

/// Length of a ray in the box, mm: from the plain equations of its six faces, in patient space.
double chordMm(const Scene& scene, const View& view, glm::dvec2 fragCoord) {
    const glm::dmat4 modelFromView = glm::inverse(view.viewFromModel);
    const glm::dmat4 uvwFromView = scene.geometry().uvwFromModel() * modelFromView;
    const Frustum& f = view.frustum;
    const glm::dvec2 tangent =
        glm::dvec2(f.left, f.bottom) +
        fragCoord / glm::dvec2(kSize) * glm::dvec2(f.right - f.left, f.top - f.bottom);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(tangent, -1.0));
    const glm::dvec3 eye = glm::dvec3(uvwFromView * glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::dvec3 slope = glm::dmat3(uvwFromView) * direction;
    const glm::dvec3 a = (0.0 - eye) / slope;
    const glm::dvec3 b = (1.0 - eye) / slope;
    const glm::dvec3 enter = glm::min(a, b);
    const glm::dvec3 leave = glm::max(a, b);
    return std::max(0.0, std::min({leave.x, leave.y, leave.z}) -
                             std::max({enter.x, enter.y, enter.z, 0.0}));
}

} // namespace

// One material of a constant colour: alpha = 1 - exp(-sigma L), colour = c alpha, L the ray's
// length in the box, for any segment form and lattice, jittered or not. Only rounding is left: of
// every plane's blend, of float32 (2^-16 of sigma L: the box's ends are found to 2^-22 of their
// terms, about 40 layers), and where a ray grazes the box.
TEST_F(RendererTest, ConstantVolumeHasTheClosedFormsOpacity) {
    const double sigma = 0.0625; // exact in the table's fp16
    const glm::dvec3 color(1.0, 0.5, 0.25);
    const Scene scene =
        makeScene(constantVolume({24, 17, 20}, 100), {.tf = uniformTransfer(sigma, color)});
    const View view = asymmetricView(scene);
    for (const TargetFormat target : {TargetFormat::Rgba16f, TargetFormat::Rgba8}) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            for (const SegmentCase& segment : kSegmentCases) {
                Settings settings = segments(segment.layersPerPlane, segment.form);
                settings.target = target;
                settings.lattice = lattice;
                settings.jitter = segment.layersPerPlane % 2 == 1;
                const FramePlan plan = decide(scene, settings);
                const Picture picture = draw(scene, plan, view, kSize);
                double worst = 0.0;
                int inside = 0;
                for (int y = 0; y < kSize.y; ++y) {
                    for (int x = 0; x < kSize.x; ++x) {
                        const double depth = sigma * chordMm(scene, view, glm::dvec2(x, y) + 0.5);
                        const double alpha = 1.0 - std::exp(-depth);
                        inside += depth > 0.0;
                        const glm::dvec4 off =
                            glm::abs(picture.at({x, y}) - glm::dvec4(color * alpha, alpha));
                        worst = std::max({worst, off.x, off.y, off.z, off.w});
                    }
                }
                EXPECT_GT(inside, 1500);
                // fp16 holds sigma, but a layer's opacity to 2^-12 of it: of the whole depth, and
                // depth exp(-depth) is at most 1/e.
                const double baked = plan.variant.lengths == Lengths::Baked ? 0x1p-13 : 0.0;
                EXPECT_LE(worst, blendingBound(plan) + baked + 0x1p-16)
                    << name(target) << ", " << name(lattice) << ", " << plan.planes << " planes, "
                    << name(plan.variant);
            }
        }
    }
}

// The value along x is a ramp and so is its opacity's logarithm: seen along y, every column of the
// picture that lies within the voxels' centres has the opacity of its own value.
TEST_F(RendererTest, RampShowsEachValuesOwnOpacity) {
    const glm::ivec3 dims(33, 9, 9);
    const Volume volume = makeVolume(dims, VoxelType::U8, [](glm::ivec3 v) { return v.x; });
    // Extinction itself is piecewise linear in the table, texel by texel: 1/512 per value and mm,
    // exact in fp16.
    TransferFunction tf{.name = "ramp"};
    for (int value = 0; value <= 32; ++value) {
        tf.points.push_back({double(value), glm::dvec3(1.0), 1.0 - std::exp(-value / 512.0)});
    }
    const Scene scene = makeScene(volume, {.tf = tf}, {}, true);
    const View view = orbitView(scene, {0.0, 0.0, 400.0}, 0.1, kSize);
    const Picture picture = draw(scene, segments(kAll, SegmentForm::Loop), view, kSize);
    const glm::dmat4 modelFromView = glm::inverse(view.viewFromModel);
    const double depth = 400.0 * scene.geometry().boundingSphere().radiusMm;
    int columns = 0;
    for (int x = 0; x < kSize.x; ++x) {
        const double tangent = glm::mix(view.frustum.left, view.frustum.right, (x + 0.5) / kSize.x);
        const glm::dvec3 place =
            glm::dvec3(modelFromView * glm::dvec4(tangent * depth, 0.0, -depth, 1.0));
        if (place.x < 0.1 || place.x > 31.9) {
            continue;
        }
        ++columns;
        // 400 radii away the rays are parallel to 1/400: over half of 9 mm they drift by at most
        // 0.02 mm at the rim, evenly to both sides of the middle, so that the mean value stays.
        const double alpha = 1.0 - std::exp(-place.x / 512.0 * 9.0);
        EXPECT_NEAR(picture.at({x, kSize.y / 2}).a, alpha, 0x1p-11 + 1e-5) << x;
    }
    EXPECT_GT(columns, 40);
}

struct LookCase {
    const char* name;
    VoxelType type;
    bool exact;
    Classification classification;
    bool shaded;
    double specular; // highlights turn a filter's error in the gradient into any colour
    double meanLimit;
    Normals normals = Normals::Computed;
};

// Means: exact fields and 16-bit filters differ by float32 alone; filters of 8-bit weights and
// results by a fraction of their step, times what the table makes of it.
constexpr LookCase kLooks[] = {
    {"exact 8 bit", VoxelType::U8, true, Classification::Post, false, 0.0, 0.0001},
    {"exact 16 bit", VoxelType::U16, true, Classification::Post, false, 0.0, 0.0001},
    {"exact shaded", VoxelType::U8, true, Classification::Post, true, 0.25, 0.0001},
    {"filtered 8 bit", VoxelType::U8, false, Classification::Post, false, 0.0, 0.001},
    {"filtered 16 bit", VoxelType::U16, false, Classification::Post, false, 0.0, 0.0001},
    {"filtered shaded", VoxelType::U16, false, Classification::Post, true, 0.0, 0.0001},
    {"baked normals", VoxelType::U16, false, Classification::Post, true, 0.0, 0.0001,
     Normals::Baked},
    {"baked normals, exact", VoxelType::U8, true, Classification::Post, true, 0.25, 0.0001,
     Normals::Baked},
    {"pre-classified", VoxelType::U8, false, Classification::Pre, false, 0.0, 0.002},
    {"pre-classified lit", VoxelType::U16, false, Classification::Pre, true, 0.0, 0.002},
};

TEST_F(RendererTest, EveryPixelMatchesTheFloat64Reference) {
    Random random(1);
    for (const LookCase& c : kLooks) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            SCOPED_TRACE(std::string(c.name) + ", " + name(lattice));
            const glm::dvec3 spacing{random.in(0.7, 1.5), random.in(0.7, 1.5), random.in(0.7, 1.5)};
            const glm::ivec3 dims{16 + random.below(12), 16 + random.below(12),
                                  16 + random.below(12)};
            const Volume volume = wavyVolume(random, dims, c.type, spacing);
            Appearance look{.tf = smoothTransfer(random, c.type == VoxelType::U8 ? 255.0 : 65535.0, 0.4),
                      .classification = c.classification, .normals = c.normals};
            if (c.shaded) {
                look.shading = ShadingParameters{.specular = c.specular};
            }
            const Scene scene = makeScene(volume, look, {}, c.exact);
            Settings settings = segments(random.oneOf({8, kAll}), SegmentForm::Loop);
            settings.lattice = lattice;
            settings.jitter = random.chance(0.5);
            settings.classification = c.classification;
            settings.shaded = c.shaded;
            settings.normals = c.normals;
            const FramePlan plan = decide(scene, settings);
            const View view = asymmetricView(scene);
            expectMatchesReference(draw(scene, plan, view, kSize), scene, plan, view, c.meanLimit);
        }
    }
}

// How layers are dealt out to planes changes the order of rounding and nothing else.
TEST_F(RendererTest, RatioChangesNothingBeyondRounding) {
    Random random(2);
    const Volume volume = wavyVolume(random, {40, 37, 33}, VoxelType::U8);
    const Scene scene = makeScene(volume, {.tf = smoothTransfer(random, 255.0, 0.2)});
    const View view = asymmetricView(scene);
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        const auto drawn = [&](Settings settings, FramePlan& plan) {
            settings.lattice = lattice;
            settings.jitter = lattice == LatticeKind::Shells;
            plan = decide(scene, settings);
            return draw(scene, plan, view, kSize);
        };
        FramePlan casting;
        const Picture cast = drawn(segments(kAll, SegmentForm::Loop), casting);
        EXPECT_EQ(casting.planes, 1);
        std::vector<Settings> ratios;
        for (const int planes : {2, 7, casting.lattice.total}) {
            ratios.push_back(segments(1, SegmentForm::Loop));
            ratios.back().layersPerPlane.reset();
            ratios.back().planes = planes;
        }
        for (const int length : kUnrollLengths) {
            ratios.push_back(segments(length, SegmentForm::Unrolled));
        }
        for (const Settings& settings : ratios) {
            FramePlan plan;
            const Picture picture = drawn(settings, plan);
            EXPECT_LE(largestDifference(picture, cast),
                      blendingBound(plan) + blendingBound(casting))
                << plan.planes << " planes, " << name(plan.variant);
        }
    }
}

// Red fades into green behind it, so what is left out shows. Where both are of one colour nothing
// does: a segment that was left early is closed in the colour it had.
TEST_F(RendererTest, TerminationLosesNoMoreThanItsThreshold) {
    const Volume ramp = makeVolume({30, 30, 30}, VoxelType::U8, [](glm::ivec3 v) { return v.y; });
    const auto sceneOf = [&](glm::dvec3 behind) {
        const double opacity = 1.0 - std::exp(-1.0);
        return makeScene(
            ramp, {.tf = {.points = {{0.0, {1.0, 0.5, 0.0}, opacity}, {29.0, behind, opacity}}}});
    };
    const Scene scene = sceneOf({0.0, 1.0, 0.0});
    const Scene plain = sceneOf({1.0, 0.5, 0.0});
    const View view = asymmetricView(scene);
    for (const SegmentForm form : {SegmentForm::Loop, SegmentForm::Unrolled}) {
        Settings settings = segments(32, form);
        const FramePlan all = decide(scene, settings);
        const FramePlan allOfPlain = decide(plain, settings);
        settings.termination = 0.9;
        const FramePlan early = decide(scene, settings);
        ASSERT_TRUE(early.variant.terminates);
        const double lost =
            largestDifference(draw(scene, all, view, kSize), draw(scene, early, view, kSize));
        EXPECT_GT(lost, 0.01); // it did leave
        const double rounding = blendingBound(all) + blendingBound(early);
        EXPECT_LE(lost, 0.1 + rounding);
        const Picture whole = draw(plain, allOfPlain, view, kSize);
        const Picture closed = draw(plain, decide(plain, settings), view, kSize);
        double ofOneColour = 0.0;
        for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
            const glm::vec4 off = glm::abs(whole.pixels[i] - closed.pixels[i]);
            if (whole.pixels[i].a > 0.9999F) {
                ofOneColour = std::max({ofOneColour, double(off.x), double(off.y), double(off.a)});
            }
        }
        EXPECT_LE(ofOneColour, rounding + 1e-4);
    }
}

TEST_F(RendererTest, CompositesOverWhatIsThere) {
    Random random(3);
    const Volume volume = wavyVolume(random, {24, 24, 24}, VoxelType::U8);
    const Scene scene = makeScene(volume, {.tf = smoothTransfer(random, 255.0, 0.1)});
    const View view = asymmetricView(scene);
    const FramePlan plan = decide(scene, segments(16, SegmentForm::Loop));
    const Picture alone = draw(scene, plan, view, kSize);
    const glm::vec4 background(0.25F, 0.5F, 0.75F, 1.0F);
    const Picture over = draw(scene, plan, view, kSize, background);
    double worst = 0.0;
    for (std::size_t i = 0; i < alone.pixels.size(); ++i) {
        const glm::vec4 expected = alone.pixels[i] + (1.0F - alone.pixels[i].a) * background;
        const glm::vec4 off = glm::abs(over.pixels[i] - expected);
        worst = std::max({worst, double(off.x), double(off.y), double(off.z), double(off.w)});
    }
    EXPECT_LE(worst, 2.0 * blendingBound(plan));
}

TEST_F(RendererTest, TouchesNothingOutsideTheViewport) {
    const Viewport viewport{11, 7, 40, 31};
    for (const CompositingSpace space : {CompositingSpace::Display, CompositingSpace::Linear}) {
        const Scene scene =
            makeScene(constantVolume({16, 16, 16}, 5),
                      {.tf = uniformTransfer(1.0, glm::dvec3(1.0)), .space = space});
        // All planes cover the whole viewport.
        const View inside = orbitView(scene, {0.0, 0.0, 0.1}, 60.0, kSize);
        Settings settings = segments(4, SegmentForm::Loop);
        settings.space = space;
        const FramePlan plan = decide(scene, settings);
        gl::ColorTargets target;
        ASSERT_TRUE(target.resize(kSize.x, kSize.y, {GL_RGBA16F}).has_value());
        target.begin(glm::vec4(0.5F));
        const ViewTarget where{inside, target.framebuffer(), viewport};
        ASSERT_TRUE(renderer().prepare(scene, plan, {&where, 1}).has_value());
        ASSERT_TRUE(renderer().draw(scene, plan, {&where, 1}).has_value());
        const Picture picture{kSize, target.read()};
        for (int y = 0; y < kSize.y; ++y) {
            for (int x = 0; x < kSize.x; ++x) {
                const bool within = x >= 11 && x < 51 && y >= 7 && y < 38;
                ASSERT_EQ(picture.at({x, y}) == glm::dvec4(0.5), !within) << x << ',' << y;
            }
        }
    }
}

TEST_F(RendererTest, NothingVisibleLeavesTheTargetAlone) {
    const TransferFunction nothing{.points = {{0.0, glm::dvec3(1.0), 0.0},
                                              {200.0, glm::dvec3(1.0), 0.0},
                                              {201.0, glm::dvec3(1.0), 1.0}}};
    const Volume dark = makeVolume({9, 9, 9}, VoxelType::U8, [](glm::ivec3 v) { return v.x; });
    const Scene scene = makeScene(dark, {.tf = nothing});
    const FramePlan plan = decide(scene, segments(4, SegmentForm::Loop));
    EXPECT_TRUE(plan.drawsNothing);
    const Picture picture = draw(scene, plan, asymmetricView(scene), kSize, glm::vec4(0.25F));
    EXPECT_TRUE(std::all_of(picture.pixels.begin(), picture.pixels.end(),
                            [](glm::vec4 p) { return p == glm::vec4(0.25F); }));
}

// One renderer serves any number of scenes: what it made for one is not taken for another's.
TEST_F(RendererTest, ScenesDoNotSeeEachOthersTextures) {
    const auto picture = [&](int value, double extinction, SkipStructure skip) {
        const Volume volume = makeVolume({16, 16, 16}, VoxelType::U8,
                                         [=](glm::ivec3 v) { return v.x < value ? 0 : value; });
        const TransferFunction tf{.points = {{1.0, glm::dvec3(1.0), 0.0},
                                             {12.0, glm::dvec3(1.0), 1.0 - std::exp(-extinction)}}};
        const Scene scene = makeScene(volume, {.tf = tf}); // at the same address as the one before
        Settings settings = segments(8, SegmentForm::Loop);
        settings.skip = skip;
        return draw(scene, settings, asymmetricView(scene), kSize);
    };
    const Picture first = picture(4, 0.1, SkipStructure::Proximity);
    const Picture volumeChanged = picture(12, 0.1, SkipStructure::Proximity);
    const Picture tableChanged = picture(4, 0.9, SkipStructure::Proximity);
    renderer().contextLost();
    EXPECT_EQ(differingPixels(picture(12, 0.1, SkipStructure::None), volumeChanged), 0);
    renderer().contextLost();
    EXPECT_EQ(differingPixels(picture(4, 0.9, SkipStructure::None), tableChanged), 0);
    renderer().contextLost();
    EXPECT_EQ(differingPixels(picture(4, 0.1, SkipStructure::None), first), 0);
    EXPECT_GT(differingPixels(first, tableChanged), 100);
}

TEST_F(RendererTest, PictureIsTheSameAfterTheContextWasLost) {
    Random random(4);
    const Volume volume = wavyVolume(random, {20, 20, 20}, VoxelType::U8);
    for (const Classification classification : {Classification::Post, Classification::Pre}) {
        const Scene scene = makeScene(volume, {.tf = smoothTransfer(random, 255.0, 0.3),
                                               .space = CompositingSpace::Linear,
                                               .classification = classification});
        Settings settings = segments(16, SegmentForm::Unrolled);
        settings.skip = SkipStructure::Proximity;
        settings.space = CompositingSpace::Linear;
        settings.classification = classification;
        const Picture before = draw(scene, settings, asymmetricView(scene), kSize);
        renderer().contextLost();
        EXPECT_EQ(renderer().gpuMemory().volumeBytes, 0);
        EXPECT_EQ(differingPixels(before, draw(scene, settings, asymmetricView(scene), kSize)), 0);
        EXPECT_GT(renderer().gpuMemory().volumeBytes, 0);
    }
}

// 16-bit voxels, whatever format the device is left with: the texels err by no more than is
// reported, and the picture follows the texels (EveryPixelMatchesTheFloat64Reference draws 16-bit
// volumes here too).
TEST_F(RendererTest, SixteenBitVoxelsKeepTheReportedError) {
    const Volume volume = makeVolume({32, 32, 32}, VoxelType::U16,
                                     [](glm::ivec3 v) { return v.x * 2047 + v.y * 33 + v.z; });
    const TransferFunction tf{
        .points = {{0.0, glm::dvec3(0.0), 0.0}, {65535.0, glm::dvec3(1.0), 0.5}}};
    for (const bool exact : {false, true}) {
        const Scene scene = makeScene(volume, {.tf = tf}, {}, exact);
        double worst = 0.0;
        for (int i = 0; i < 32 * 32 * 32; ++i) {
            const glm::ivec3 voxel(i % 32, i / 32 % 32, i / 1024);
            worst = std::max(worst,
                             std::abs(decodedValue(scene.texels(), voxel) - volume.valueAt(voxel)));
        }
        EXPECT_LE(worst, scene.texels().maxQuantisationError * (1.0 + 1e-12) + 1e-9);
        EXPECT_EQ(scene.texels().format == TexelFormat::R16F, !exact && !formats()[1].usable);
        if (exact || formats()[1].usable) {
            EXPECT_EQ(scene.texels().maxQuantisationError, 0.0);
        } else {
            EXPECT_GT(worst, 0.0); // 16 bits do not fit
            EXPECT_LE(worst, 65535.0 * 0x1p-12);
        }
        const FramePlan plan = decide(scene, segments(kAll, SegmentForm::Loop));
        const View view = asymmetricView(scene);
        expectMatchesReference(draw(scene, plan, view, kSize), scene, plan, view, 0.0001);
    }
}

} // namespace slabcast::test

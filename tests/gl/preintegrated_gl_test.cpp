#include <algorithm>
#include <cmath>
#include <string>

#include "core/reference/discrete.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

struct FieldCase {
    const char* name;
    VoxelType type;
    bool exact;
    double meanLimit; // exact fields differ by float32 alone, filtered ones by a filter's weights
};

constexpr FieldCase kFields[] = {
    {"exact 8 bit", VoxelType::U8, true, 0.0001},
    {"exact 16 bit", VoxelType::U16, true, 0.0001},
    {"filtered 8 bit", VoxelType::U8, false, 0.001},
    {"filtered 16 bit", VoxelType::U16, false, 0.0001},
};

double highestOf(VoxelType type) {
    return type == VoxelType::U8 ? 255.0 : 65535.0;
}

Settings preintegrated(Settings settings) {
    settings.classification = Classification::Preintegrated;
    return settings;
}

Appearance preintegratedLook(TransferFunction tf) {
    return {.tf = std::move(tf), .classification = Classification::Preintegrated};
}

class PreintegratedTest : public RenderTest {};

} // namespace

TEST_F(PreintegratedTest, EveryPixelMatchesTheFloat64Reference) {
    Random random(1);
    for (const FieldCase& field : kFields) {
        for (const SegmentCase& c : kSegmentCases) {
            const glm::dvec3 spacing{random.in(0.7, 1.5), random.in(0.7, 1.5), random.in(0.7, 1.5)};
            const Volume volume = wavyVolume(random, {14, 13, 12}, field.type, spacing);
            const TransferFunction tf = smoothTransfer(random, highestOf(field.type), 0.4);
            const Scene scene = makeScene(volume, preintegratedLook(tf), {}, field.exact);
            Settings settings = preintegrated(segments(c.layersPerPlane, c.form));
            settings.lattice = random.oneOf({LatticeKind::Planar, LatticeKind::Shells});
            settings.jitter = random.chance(0.5);
            settings.layerSpacingVoxels = random.oneOf({0.6, 1.0, 3.0});
            const FramePlan plan = decide(scene, settings);
            SCOPED_TRACE(std::string(field.name) + ", " + name(plan.variant) + ", " +
                         name(plan.lattice.kind));
            EXPECT_EQ(plan.variant.exactField, field.exact);
            const View view = asymmetricView(scene);
            expectMatchesReference(draw(scene, plan, view, kSize), scene, plan, view,
                                   field.meanLimit);
        }
    }
}

// The reference above walks the samples by itself; the discrete one is what errors are measured by.
TEST_F(PreintegratedTest, TheDiscreteReferenceTakesTheSameSamples) {
    Random random(2);
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        const Volume volume = wavyVolume(random, {20, 17, 18}, VoxelType::U8, {1.0, 0.8, 1.3});
        const Scene scene =
            makeScene(volume, preintegratedLook(smoothTransfer(random, 255.0, 0.5)), {}, true);
        Settings settings = preintegrated(segments(kAll, SegmentForm::Loop));
        settings.lattice = lattice;
        settings.jitter = true;
        settings.layerSpacingVoxels = 1.7;
        const FramePlan plan = decide(scene, settings);
        const View view = asymmetricView(scene);
        const Viewport viewport{0, 0, kSize.x, kSize.y};
        const std::vector<glm::dvec4> discrete = renderDiscrete({.texels = &scene.texels(),
                                                                 .geometry = scene.geometry(),
                                                                 .transfer = *scene.preintegrated(),
                                                                 .view = view,
                                                                 .viewport = viewport,
                                                                 .lattice = plan.lattice});
        const Picture drawn = draw(scene, plan, view, kSize);
        const ReferencePicture reference(scene, plan, view, viewport);
        for (int y = 0; y < kSize.y; ++y) {
            for (int x = 0; x < kSize.x; ++x) {
                const PixelReference expected = reference.at(glm::dvec2(x, y) + 0.5);
                const glm::dvec4& pixel = discrete[static_cast<std::size_t>(y) * kSize.x + x];
                ASSERT_NEAR(glm::distance(pixel, expected.color), 0.0, 1e-11) << x << " " << y;
                if (!expected.atEdge) {
                    EXPECT_LE(glm::distance(drawn.at({x, y}), pixel),
                              2.0 * (expected.bound + blendingBound(plan)));
                }
            }
        }
    }
}

// Value is x, and linear in it is the opacity: along a ray it is linear but in the outer half
// voxels, where it is constant. One layer for all of them is as good as many.
TEST_F(PreintegratedTest, AnyLengthOfALayerGivesTheSameOpacity) {
    const Volume volume = makeVolume({64, 8, 8}, VoxelType::U8, [](glm::ivec3 v) { return v.x; });
    const double perValue = 0.9 / 63.0;
    const TransferFunction tf{
        .points = {{0.0, glm::dvec3(1.0, 0.5, 0.2), 0.0}, {63.0, glm::dvec3(1.0, 0.5, 0.2), 0.9}}};
    const Scene scene = makeScene(volume, preintegratedLook(tf), {}, true);
    const View view = orbitView(scene, {0.0, 0.0, 3.0}, 20.0, kSize);
    // Near the axis: rays that cross the box from front to back, along which x changes by tan * 8.
    for (const double spacing : {0.25, 1.0, 5.0, 1000.0}) {
        Settings settings = preintegrated(segments(kAll, SegmentForm::Loop));
        settings.layerSpacingVoxels = spacing;
        const FramePlan plan = decide(scene, settings);
        const Picture picture = draw(scene, plan, view, kSize);
        const RayFrame frame =
            makeRayFrame(view, {0, 0, kSize.x, kSize.y}, scene.geometry(), plan.lattice);
        int columns = 0;
        for (int x = 0; x < kSize.x; ++x) {
            const LatticeRay ray = rayAt(frame, {x + 0.5, kSize.y / 2 + 0.5});
            const double front = (ray.centre + ray.entry * ray.step).x * 64.0 - 0.5;
            const double back = (ray.centre + ray.exit * ray.step).x * 64.0 - 0.5;
            if (!(ray.entry < ray.exit) || std::min(front, back) < 0.0 ||
                std::max(front, back) > 63.0) {
                continue;
            }
            ++columns;
            const auto antiderivative = [](double u) { return (1.0 - u) * std::log(1.0 - u) + u; };
            const double u0 = perValue * front;
            const double u1 = perValue * back;
            const double mean = std::abs(u1 - u0) < 1e-6
                                    ? -std::log(1.0 - u0)
                                    : (antiderivative(u1) - antiderivative(u0)) / (u1 - u0);
            const double lengthMm = (ray.exit - ray.entry) * ray.layerLengthMm;
            const double alpha = 1.0 - std::exp(-mean * lengthMm);
            // The table's curve over a texel (one per value) and its fp16, times the length, times
            // what is left behind it; then fp16 of the target.
            const double curve = std::pow(perValue / (1.0 - std::max(u0, u1)), 2.0);
            const double depthError = lengthMm * (curve / 12.0 + 0x1p-11 * mean);
            const double bound = (1.0 - alpha) * std::expm1(depthError) + 0x1p-11 + 1e-5;
            EXPECT_NEAR(picture.at({x, kSize.y / 2}).a, alpha, bound) << spacing << " " << x;
        }
        EXPECT_GT(columns, 40);
    }
}

// How layers are dealt out to planes changes the order of rounding and nothing else.
TEST_F(PreintegratedTest, RatioChangesNothingBeyondRounding) {
    Random random(3);
    const Volume volume = wavyVolume(random, {40, 37, 33}, VoxelType::U8);
    const Scene scene = makeScene(volume, preintegratedLook(smoothTransfer(random, 255.0, 0.2)));
    const View view = asymmetricView(scene);
    const FramePlan casting = decide(scene, preintegrated(segments(kAll, SegmentForm::Loop)));
    const Picture cast = draw(scene, casting, view, kSize);
    for (const SegmentCase& c : kSegmentCases) {
        const FramePlan plan = decide(scene, preintegrated(segments(c.layersPerPlane, c.form)));
        const Picture picture = draw(scene, plan, view, kSize);
        EXPECT_LE(largestDifference(picture, cast),
                  blendingBound(plan) + blendingBound(casting) + 1e-5)
            << name(plan.variant);
    }
}

// Eight bits round a plane's colour, its opacity, by which what is behind is dimmed, and the
// product of the two, by half a step each.
TEST_F(PreintegratedTest, EightBitsDifferByTheirSteps) {
    Random random(5);
    const Volume volume = wavyVolume(random, {30, 27, 33}, VoxelType::U8);
    const Scene scene =
        makeScene(volume, preintegratedLook(smoothTransfer(random, 255.0, 0.3)), {}, true);
    const View view = asymmetricView(scene);
    for (const int layersPerPlane : {1, 8, kAll}) {
        Settings settings = preintegrated(segments(layersPerPlane, SegmentForm::Loop));
        const FramePlan wide = decide(scene, settings);
        settings.target = TargetFormat::Rgba8;
        const FramePlan narrow = decide(scene, settings);
        EXPECT_LE(
            largestDifference(draw(scene, wide, view, kSize), draw(scene, narrow, view, kSize)),
            blendingBound(narrow) + blendingBound(wide))
            << layersPerPlane;
    }
}

// L layers take L + 1 samples: planes of one layer take both of their ends, one plane for all takes
// every end once. Whatever is skipped, nothing is fetched twice within a segment.
TEST_F(PreintegratedTest, ARunOfLayersTakesOneSampleMore) {
    if (!caps().floatBlend) {
        GTEST_SKIP() << "float32 targets do not blend here (masked): work cannot be counted";
    }
    const Scene scene = makeScene(constantVolume({9, 9, 9}, 7),
                                  preintegratedLook(uniformTransfer(0.1, glm::dvec3(1.0))));
    const View view = asymmetricView(scene);
    for (const SegmentCase& c : kSegmentCases) {
        const FramePlan plan = decide(scene, preintegrated(segments(c.layersPerPlane, c.form)));
        const ViewTarget target{view, 0, {0, 0, kSize.x, kSize.y}, TargetEncoding::Encoded};
        ASSERT_TRUE(renderer().prepare(scene, plan, {&target, 1}).has_value());
        const Result<WorkCounters> work = renderer().countWork(scene, plan, {&target, 1});
        ASSERT_TRUE(work.has_value());
        // Groups that meet the box, and their layers, from the rays alone.
        const int group = groupOf(plan.variant);
        const RayFrame frame =
            makeRayFrame(view, {0, 0, kSize.x, kSize.y}, scene.geometry(), plan.lattice);
        std::int64_t layers = 0;
        std::int64_t runs = 0;
        for (int y = 0; y < kSize.y; ++y) {
            for (int x = 0; x < kSize.x; ++x) {
                const LayerRange range =
                    layersOf(rayAt(frame, glm::dvec2(x, y) + 0.5), plan.lattice.total);
                for (int front = 0; front < plan.lattice.total; front += plan.layersPerPlane) {
                    const int begin = std::max(range.begin - front, 0);
                    const int end = std::min(range.end - front, plan.layersPerPlane);
                    // A loop's first group begins where the stay does.
                    const int first = plan.variant.unroll > 0 ? begin / group * group : begin;
                    runs += begin < end ? (end - first + group - 1) / group : 0;
                }
            }
        }
        layers = runs * group;
        // Where a ray grazes a layer's end, float32 may see one more or less.
        const double slack = 0.002 * static_cast<double>(layers);
        EXPECT_NEAR(double(work->layersEvaluated), double(layers), slack) << name(plan.variant);
        EXPECT_NEAR(double(work->volumeFetches), double(layers + runs), 2.0 * slack)
            << name(plan.variant);
    }
}

// Nothing but one table is there for it, and that goes when the look does.
TEST_F(PreintegratedTest, ItsTableTakesThePlaceOfTheOther) {
    const Volume volume = makeVolume({64, 3, 3}, VoxelType::U8, [](glm::ivec3 v) { return v.x; });
    const TransferFunction tf{
        .points = {{10.0, glm::dvec3(1.0), 0.0}, {50.0, glm::dvec3(0.3), 0.9}}};
    Scene scene = makeScene(volume, preintegratedLook(tf));
    const View view = asymmetricView(scene);
    ASSERT_NE(scene.preintegrated(), nullptr);
    EXPECT_EQ(scene.preintegrated()->size(), 41);
    const auto bytesOf = [&](const Settings& settings) {
        draw(scene, settings, view, kSize);
        return renderer().gpuMemory().otherBytes;
    };
    const std::int64_t square = bytesOf(preintegrated(segments(8, SegmentForm::Loop)));
    ASSERT_TRUE(show(scene, {.tf = tf}, {}).has_value());
    EXPECT_EQ(scene.preintegrated(), nullptr);
    const std::int64_t line = bytesOf(segments(8, SegmentForm::Loop));
    EXPECT_EQ(square - line, 8 * (41 * 41 - 41));
}

} // namespace slabcast::test

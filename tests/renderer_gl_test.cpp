#include <algorithm>
#include <cmath>
#include <set>

#include "core/frame/ratio_tuner.h"
#include "core/gl/program.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

constexpr glm::ivec2 kSize(96, 72);

class RendererTest : public RenderTest {};

struct SegmentCase {
    int layersPerPlane;
    SegmentForm form;
};

constexpr int kAll = 1 << 20; // more layers than there are: one plane
constexpr SegmentCase kSegmentCases[] = {{1, SegmentForm::Unrolled}, {1, SegmentForm::Loop}, {8, SegmentForm::Unrolled},
                                         {11, SegmentForm::Loop},    {kAll, SegmentForm::Loop}};

/// Above 2.5 radii away, turned about two axes and seen past the middle: nothing is symmetric.
View asymmetricView(const Scene& scene) {
    View view = orbitView(scene, {35.0, 20.0, 2.5}, 45.0, kSize);
    view.frustum.left -= 0.11;
    view.frustum.right -= 0.11;
    view.frustum.top += 0.06;
    view.frustum.bottom += 0.06;
    return view;
}

/// Length of a ray in the box, mm: from the plain equations of its six faces, in patient space.
double chordMm(const Scene& scene, const View& view, glm::dvec2 fragCoord) {
    const glm::dmat4 modelFromView = glm::inverse(view.viewFromModel);
    const glm::dmat4 uvwFromView = scene.geometry().uvwFromModel() * modelFromView;
    const Frustum& f = view.frustum;
    const glm::dvec2 tangent = glm::dvec2(f.left, f.bottom) +
                               fragCoord / glm::dvec2(kSize) * glm::dvec2(f.right - f.left, f.top - f.bottom);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(tangent, -1.0));
    const glm::dvec3 eye = glm::dvec3(uvwFromView * glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::dvec3 slope = glm::dmat3(uvwFromView) * direction;
    const glm::dvec3 a = (0.0 - eye) / slope;
    const glm::dvec3 b = (1.0 - eye) / slope;
    const glm::dvec3 enter = glm::min(a, b);
    const glm::dvec3 leave = glm::max(a, b);
    return std::max(0.0, std::min({leave.x, leave.y, leave.z}) - std::max({enter.x, enter.y, enter.z, 0.0}));
}

} // namespace

// One material of a constant colour: alpha = 1 - exp(-sigma L), colour = c alpha, L the ray's length in the box, for
// any segment form and lattice. Only rounding is left: of every plane's blend, of float32 (2^-16 of sigma L: the box's
// ends are found to 2^-22 of their terms, about 40 layers), and where a ray grazes the box.
TEST_F(RendererTest, ConstantVolumeHasTheClosedFormsOpacity) {
    const double sigma = 0.0625; // exact in the table's fp16
    const glm::dvec3 color(1.0, 0.5, 0.25);
    const Scene scene = makeScene(constantVolume({24, 17, 20}, 100), {.tf = uniformTransfer(sigma, color)});
    const View view = asymmetricView(scene);
    for (const TargetFormat target : {TargetFormat::Rgba16f, TargetFormat::Rgba8}) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            for (const SegmentCase& segment : kSegmentCases) {
                Settings settings = segments(segment.layersPerPlane, segment.form);
                settings.target = target;
                settings.lattice = lattice;
                const FramePlan plan = decide(scene, settings);
                const Picture picture = draw(scene, plan, view, kSize);
                double worst = 0.0;
                int inside = 0;
                for (int y = 0; y < kSize.y; ++y) {
                    for (int x = 0; x < kSize.x; ++x) {
                        const double depth = sigma * chordMm(scene, view, glm::dvec2(x, y) + 0.5);
                        const double alpha = 1.0 - std::exp(-depth);
                        inside += depth > 0.0;
                        const glm::dvec4 off = glm::abs(picture.at({x, y}) - glm::dvec4(color * alpha, alpha));
                        worst = std::max({worst, off.x, off.y, off.z, off.w});
                    }
                }
                EXPECT_GT(inside, 1500);
                EXPECT_LE(worst, blendingBound(plan) + 0x1p-16)
                    << name(target) << ", " << name(lattice) << ", " << plan.planes << " planes, "
                    << name(plan.variant);
            }
        }
    }
}

// The value along x is a ramp and so is its opacity's logarithm: seen along y, every column of the picture that lies
// within the voxels' centres has the opacity of its own value.
TEST_F(RendererTest, RampShowsEachValuesOwnOpacity) {
    const glm::ivec3 dims(33, 9, 9);
    const Volume volume = makeVolume(dims, VoxelType::U8, [](glm::ivec3 v) { return v.x; });
    // Extinction itself is piecewise linear in the table, texel by texel: 1/512 per value and mm, exact in fp16.
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
        const glm::dvec3 place = glm::dvec3(modelFromView * glm::dvec4(tangent * depth, 0.0, -depth, 1.0));
        if (place.x < 0.1 || place.x > 31.9) {
            continue;
        }
        ++columns;
        // 400 radii away the rays are parallel to 1/400: over half of 9 mm they drift by at most 0.02 mm at the rim,
        // evenly to both sides of the middle, so that the mean value stays.
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
};

// Means: exact fields and 16-bit filters differ by float32 alone; filters of 8-bit weights and results by a fraction
// of their step, times what the table makes of it.
constexpr LookCase kLooks[] = {
    {"exact 8 bit", VoxelType::U8, true, Classification::Post, false, 0.0, 0.0001},
    {"exact 16 bit", VoxelType::U16, true, Classification::Post, false, 0.0, 0.0001},
    {"exact shaded", VoxelType::U8, true, Classification::Post, true, 0.25, 0.0001},
    {"filtered 8 bit", VoxelType::U8, false, Classification::Post, false, 0.0, 0.001},
    {"filtered 16 bit", VoxelType::U16, false, Classification::Post, false, 0.0, 0.0001},
    {"filtered shaded", VoxelType::U16, false, Classification::Post, true, 0.0, 0.0001},
    {"pre-classified", VoxelType::U8, false, Classification::Pre, false, 0.0, 0.002},
    {"pre-classified lit", VoxelType::U16, false, Classification::Pre, true, 0.0, 0.002},
};

TEST_F(RendererTest, EveryPixelMatchesTheFloat64Reference) {
    Random random(1);
    for (const LookCase& c : kLooks) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            SCOPED_TRACE(std::string(c.name) + ", " + name(lattice));
            const glm::dvec3 spacing{random.in(0.7, 1.5), random.in(0.7, 1.5), random.in(0.7, 1.5)};
            const glm::ivec3 dims{16 + random.below(12), 16 + random.below(12), 16 + random.below(12)};
            const Volume volume = wavyVolume(random, dims, c.type, spacing);
            Look look{.tf = smoothTransfer(random, c.type == VoxelType::U8 ? 255.0 : 65535.0, 0.4),
                      .classification = c.classification};
            if (c.shaded) {
                look.shading = ShadingParameters{.specular = c.specular};
            }
            const Scene scene = makeScene(volume, look, {}, c.exact);
            Settings settings = segments(random.oneOf({8, kAll}), SegmentForm::Loop);
            settings.lattice = lattice;
            settings.classification = c.classification;
            settings.shaded = c.shaded;
            const FramePlan plan = decide(scene, settings);
            const View view = asymmetricView(scene);
            expectMatchesReference(draw(scene, plan, view, kSize), scene, plan, view, c.meanLimit);
        }
    }
}

} // namespace slabcast::test

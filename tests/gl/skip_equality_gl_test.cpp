#include <algorithm>
#include <cmath>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

constexpr glm::ivec2 kSmall(48, 36);

/// Most of it empty, as volumes are: clusters of values in air, single spikes, thin plates or
/// waves.
Volume randomVolume(Random& random) {
    const glm::ivec3 dims{random.oneOf({1, 2, 7, 16, 23, 33}), random.oneOf({1, 3, 8, 17, 32}),
                          random.oneOf({1, 5, 12, 16, 29})};
    const glm::dvec3 spacing =
        random.chance(0.5)
            ? glm::dvec3(1.0)
            : glm::dvec3{random.in(0.5, 2.0), random.in(0.5, 2.0), random.in(0.5, 2.0)};
    const VoxelType type = random.oneOf({VoxelType::U8, VoxelType::U16});
    const double highest = type == VoxelType::U8 ? 255.0 : random.oneOf({4095.0, 65535.0});
    const int kind = random.below(4);
    const glm::dvec3 middle =
        glm::dvec3{random.in(0.0, 1.0), random.in(0.0, 1.0), random.in(0.0, 1.0)} *
        glm::dvec3(dims);
    const double radius = random.in(1.0, 10.0);
    const int plate = random.below(dims.z);
    const auto formula = [&](glm::ivec3 v) {
        switch (kind) {
        case 0: // a ball with a soft rim and noise inside
            return std::clamp(radius - glm::distance(glm::dvec3(v), middle), 0.0, 3.0) / 3.0 *
                   random.in(0.5, 1.0) * highest;
        case 1: // spikes
            return random.chance(0.01) ? random.in(0.2, 1.0) * highest : 0.0;
        case 2: // a plate
            return v.z == plate ? random.in(0.0, 1.0) * highest : 0.0;
        default:
            return highest * 0.5 *
                   (1.0 + std::sin(v.x * 0.21 + radius) * std::cos(v.y * 0.17 + v.z * 0.11));
        }
    };
    Volume volume = makeVolume(dims, type, formula, spacing);
    if (random.chance(0.3)) {
        volume.geometry.direction =
            glm::dmat3(glm::rotate(glm::dmat4(1.0), random.in(0.0, 6.0),
                                   glm::normalize(glm::dvec3(1.0, random.in(-1.0, 1.0), 0.3))));
    }
    return volume;
}

/// Narrow bands with steps, spikes a fraction of a value wide, ramps: all within [0, highest].
TransferFunction randomTransfer(Random& random, double highest) {
    TransferFunction tf{.name = "random", .opacityUnitMm = random.in(0.3, 3.0)};
    const double strongest = random.oneOf({0.01, 0.5, 1.0});
    double value = random.in(0.0, 0.5) * highest;
    const auto add = [&](double at, double opacity) {
        const glm::dvec3 color{random.in(0.0, 1.0), random.in(0.0, 1.0), random.in(0.0, 1.0)};
        tf.points.push_back({at, color, opacity});
    };
    const int bands = 1 + random.below(3);
    for (int band = 0; band < bands; ++band) {
        const double width = random.oneOf({0.0, 0.3, 0.02 * highest, 0.2 * highest});
        const double opacity = random.in(0.0, strongest);
        add(value, 0.0);
        if (width > 0.0 && random.chance(0.5)) {
            add(value, opacity);
            add(value + width, opacity);
            add(value + width, 0.0);
        } else {
            add(value + std::max(width, 0.1), opacity);
            add(value + 2.0 * std::max(width, 0.1), 0.0);
        }
        value = tf.points.back().value + random.in(0.01, 0.3) * highest;
    }
    return tf;
}

View randomView(Random& random, const Scene& scene) {
    const OrbitCamera camera{random.in(0.0, 360.0), random.in(-90.0, 90.0),
                             random.oneOf({0.3, 1.1, 2.0, 3.0, 12.0})};
    View view = orbitView(scene, camera, random.oneOf({20.0, 50.0, 90.0}), kSmall);
    const double shift = random.chance(0.5) ? random.in(-0.3, 0.3) : 0.0;
    view.frustum.left += shift;
    view.frustum.right += shift;
    if (random.chance(0.2)) {
        view.nearDepth =
            random.in(0.0, camera.distanceRadii) * scene.geometry().boundingSphere().radiusMm;
    }
    return view;
}

Settings randomSettings(Random& random) {
    Settings settings;
    settings.form = random.chance(0.2) ? SegmentForm::Unrolled : SegmentForm::Loop;
    // Leaps stay within a segment: long ones show a leap that goes too far.
    settings.layersPerPlane = settings.form == SegmentForm::Unrolled
                                  ? random.oneOf({1, 16})
                                  : random.oneOf({1, 16, kAll, kAll});
    settings.layerSpacingVoxels = random.oneOf({0.125, 0.5, 1.0, 4.0});
    settings.lattice = random.oneOf({LatticeKind::Planar, LatticeKind::Shells});
    settings.target = random.oneOf({TargetFormat::Rgba8, TargetFormat::Rgba16f});
    if (random.chance(0.5)) {
        settings.termination.reset();
    }
    return settings;
}

SkipOptions randomOptions(Random& random, const SkipStructureInfo& info) {
    SkipOptions options{.structure = info.structure};
    options.blockEdgeVoxels =
        info.edges[static_cast<std::size_t>(random.below(static_cast<int>(info.edges.size())))];
    options.bits = random.oneOf({8, 16, 32, 64, 128});
    options.partitions = random.oneOf({16, 32, 256});
    options.separateMinimum = random.chance(0.5);
    options.initialLevel = random.below(5);
    options.traversal = random.oneOf({Traversal::Bidirectional, Traversal::TopDown});
    return options;
}

bool showsSomething(const Picture& picture) {
    return std::any_of(picture.pixels.begin(), picture.pixels.end(),
                       [](glm::vec4 p) { return p.a > 0.0F; });
}

class SkipEqualityTest : public RenderTest {
protected:
    /// Draws one random scene plainly and in every way of skipping; returns whether anything was to
    /// be seen.
    bool drawAllWays(std::uint64_t seed, bool exact, Classification classification, bool shaded) {
        Random random(seed);
        const Volume volume = randomVolume(random);
        const double highest = std::max(1.0, computeStatistics(volume).max);
        Appearance look{.tf = randomTransfer(random, highest), .classification = classification};
        if (shaded) {
            look.shading = ShadingParameters{};
            look.normals = seed % 2 == 0 ? Normals::Computed : Normals::Baked;
        }
        Scene scene = makeScene(volume, look, {.structure = SkipStructure::None}, exact);
        Settings settings = randomSettings(random);
        settings.classification = classification;
        settings.shaded = shaded;
        settings.normals = look.normals;
        if (shaded) { // seven fields per sample
            settings.layerSpacingVoxels = std::max(settings.layerSpacingVoxels, 0.5);
        }
        const View view = randomView(random, scene);
        const Picture plain = draw(scene, settings, view, kSmall);
        // Two of seven: every program takes a software driver a third of a second to compile.
        for (int k = 0; k < 2; ++k) {
            const SkipStructureInfo& info =
                skipStructures()[static_cast<std::size_t>(1 + random.below(7))];
            const SkipOptions options = randomOptions(random, info);
            const Result<void> set = show(scene, look, options);
            EXPECT_TRUE(set.has_value()) << (set ? "" : set.error().detail);
            settings.skip = random.chance(0.9) ? info.structure : SkipStructure::None;
            settings.tighten = random.chance(0.5);
            const FramePlan plan = decide(scene, settings);
            const Picture picture = draw(scene, plan, view, kSmall);
            EXPECT_EQ(differingPixels(plain, picture), 0)
                << "seed " << seed << ", " << name(plan.skip) << " of edge "
                << options.blockEdgeVoxels << ", " << name(plan.variant)
                << (plan.tighten ? ", tight, " : ", ") << name(plan.lattice.kind) << ", "
                << plan.planes << "x" << plan.layersPerPlane << ", " << name(plan.target)
                << ", off by " << largestDifference(plain, picture);
        }
        return showsSomething(plain);
    }

    void drawScenes(std::uint64_t firstSeed, int count, bool exact, Classification classification,
                    bool shaded) {
        // Some scenes are empty, others after the texel format: on, until enough were not.
        int seen = 0;
        for (int k = 0; k < count || (seen < count / 3 && k < 3 * count); ++k) {
            seen += drawAllWays(firstSeed + static_cast<std::uint64_t>(k), exact, classification,
                                shaded);
        }
        EXPECT_GE(seen, count / 3) << "too many of the scenes were empty to prove anything";
    }
};

} // namespace

// Single visible voxels far apart: every leap ends next to something that it must not miss. Leaps
// that are two voxels too long show here; the first voxel is what blocks are grown by.
TEST_F(SkipEqualityTest, SparseVoxels) {
    constexpr glm::ivec2 size(160, 120);
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        Random random(seed);
        const auto spike = [&](glm::ivec3) { return random.chance(0.002) ? 255.0 : 0.0; };
        const Volume volume = makeVolume({40, 37, 33}, VoxelType::U8, spike, {1.0, 1.5, 0.8});
        const TransferFunction tf{
            .points = {{4.0, glm::dvec3(0.2), 0.0}, {255.0, glm::dvec3(1.0), 0.7}}};
        const Scene scene =
            makeScene(volume, {.tf = tf}, {.blockEdgeVoxels = random.oneOf({1, 1, 2, 4})});
        Settings settings = segments(kAll, SegmentForm::Loop);
        settings.layerSpacingVoxels = random.oneOf({0.25, 0.5, 1.0});
        settings.lattice = random.oneOf({LatticeKind::Planar, LatticeKind::Shells});
        const OrbitCamera camera{random.in(0.0, 360.0), random.in(-90.0, 90.0), 1.6};
        const View view = orbitView(scene, camera, 60.0, size);
        const Picture plain = draw(scene, settings, view, size);
        settings.skip = SkipStructure::Proximity;
        EXPECT_EQ(differingPixels(plain, draw(scene, settings, view, size)), 0) << "seed " << seed;
    }
}

TEST_F(SkipEqualityTest, PostClassified) {
    drawScenes(1000, 24, false, Classification::Post, false);
}
TEST_F(SkipEqualityTest, PostClassifiedExactField) {
    drawScenes(2000, 10, true, Classification::Post, false);
}
TEST_F(SkipEqualityTest, PreClassified) {
    drawScenes(3000, 10, false, Classification::Pre, false);
}
TEST_F(SkipEqualityTest, PreClassifiedLit) {
    drawScenes(4000, 5, false, Classification::Pre, true);
}
TEST_F(SkipEqualityTest, PreIntegrated) {
    drawScenes(7000, 10, false, Classification::Preintegrated, false);
}
TEST_F(SkipEqualityTest, PreIntegratedExactField) {
    drawScenes(8000, 5, true, Classification::Preintegrated, false);
}
TEST_F(SkipEqualityTest, Shaded) {
    drawScenes(5000, 6, false, Classification::Post, true);
}
TEST_F(SkipEqualityTest, ShadedExactField) {
    drawScenes(6000, 4, true, Classification::Post, true);
}

} // namespace slabcast::test

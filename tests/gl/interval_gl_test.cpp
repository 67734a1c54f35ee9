#include "tests/support/render_support.h"

// A stay that is not cut: the picture of the one that is, bit for bit.
namespace slabcast::test {

namespace {

class IntervalTest : public RenderTest {
protected:
    /// Something soft in the middle, nothing at the faces.
    Scene blob(Classification classification) {
        const Volume volume = makeVolume({30, 26, 28}, VoxelType::U8, [](glm::ivec3 v) {
            const double r = glm::distance(glm::dvec3(v), glm::dvec3(15.0, 13.0, 14.0));
            return std::max(0.0, 240.0 - 40.0 * r) + (v.x * 7 + v.y * 3 + v.z) % 5;
        });
        const TransferFunction tf{.points = {{20.0, glm::dvec3(1.0, 0.3, 0.1), 0.0},
                                             {230.0, glm::dvec3(0.4, 1.0, 0.9), 0.6}}};
        return makeScene(volume, {.tf = tf, .classification = classification},
                         {.blockEdgeVoxels = 4});
    }
};

Settings tightSettings(Classification classification, int layers, LatticeKind lattice) {
    Settings settings =
        segments(layers, layers == kAll ? SegmentForm::Loop : SegmentForm::Unrolled);
    settings.classification = classification;
    settings.lattice = lattice;
    settings.termination = 0.98;
    settings.skip.reset();
    return settings;
}

} // namespace

TEST_F(IntervalTest, NotCutIsThePictureOfTheCutOne) {
    for (const Classification way :
         {Classification::Post, Classification::Pre, Classification::Preintegrated}) {
        const Scene scene = blob(way);
        const View view = asymmetricView(scene);
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            for (const int layers : {1, 8, 16, kAll}) {
                const Settings settings = tightSettings(way, layers, lattice);
                const FramePlan open = decide(scene, settings);
                const bool reachesFarther =
                    way == Classification::Preintegrated && lattice == LatticeKind::Planar;
                ASSERT_EQ(open.variant.interval == Interval::None, !reachesFarther)
                    << name(open.variant);
                FramePlan cut = open;
                cut.variant = cutVariant(open);
                const Picture picture = draw(scene, open, view, kSize);
                EXPECT_EQ(differingPixels(picture, draw(scene, cut, view, kSize)), 0)
                    << name(open.variant) << ", " << name(lattice);
                EXPECT_GT(differingPixels(picture, cleared(open, kSize, {})), 100);
            }
        }
    }
}

// With the near plane, or the eye, among the layers the variant that cuts is drawn.
TEST_F(IntervalTest, NearPlaneAndEyeAreCutAt) {
    const Scene scene = blob(Classification::Post);
    const double radius = scene.geometry().boundingSphere().radiusMm;
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        const FramePlan open = decide(scene, tightSettings(Classification::Post, 16, lattice));
        ASSERT_EQ(open.variant.interval, Interval::None);
        FramePlan cut = open;
        cut.variant = cutVariant(open);
        for (const double distance : {0.0, 0.4, 2.0}) {
            View view = orbitView(scene, {40.0, 20.0, distance}, 60.0, kSize);
            view.nearDepth = std::max(0.01 * radius, (distance - 0.1) * radius);
            const RayFrame frame =
                makeRayFrame(view, {0, 0, kSize.x, kSize.y}, scene.geometry(), open.lattice);
            EXPECT_EQ(variantFor(open, frame, view.frustum), cut.variant) << distance;
            const Picture picture = draw(scene, open, view, kSize);
            EXPECT_EQ(differingPixels(picture, draw(scene, cut, view, kSize)), 0) << distance;
            EXPECT_GT(differingPixels(picture, cleared(open, kSize, {})), 100) << distance;
        }
    }
}

// What is visible at a face, an edited look, and planes wider than what is visible keep the cut.
TEST_F(IntervalTest, IsCutWhereSomethingMayBeSeenAtAFace) {
    const Settings settings = tightSettings(Classification::Post, 16, LatticeKind::Shells);
    const Scene full =
        makeScene(constantVolume({20, 20, 20}, 100), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    EXPECT_EQ(decide(full, settings).variant.interval, Interval::Box);
    const Scene scene = blob(Classification::Post);
    Settings wide = settings;
    wide.tighten = false;
    EXPECT_EQ(decide(scene, wide).variant.interval, Interval::Box);
    Settings looped = settings; // whose groups begin where leaps end
    looped.form = SegmentForm::Loop;
    EXPECT_EQ(decide(scene, looped).variant.interval, Interval::Box);
    Settings uneven = settings;
    uneven.layersPerPlane = 13; // written out as 16
    EXPECT_EQ(decide(scene, uneven).variant.interval, Interval::Box);
}

} // namespace slabcast::test

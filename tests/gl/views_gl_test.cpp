#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "core/gl/state_guard.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

/// Exact fields differ from float64 by the table's and the positions' rounding: far below one of
/// 255 steps.
constexpr double kMeanLimit = 0.0001;

class ViewsTest : public RenderTest {
protected:
    Scene wavyScene(std::uint64_t seed, double mostOpacity = 0.2) {
        Random random(seed);
        const Volume volume = wavyVolume(random, {28, 21, 24}, VoxelType::U8, {1.0, 1.3, 0.9});
        return makeScene(volume, {.tf = smoothTransfer(random, 255.0, mostOpacity)}, {}, true);
    }

    /// In every segment form and lattice, each tightened and not.
    void expectAllMatch(const Scene& scene, const View& view) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            for (const int layers : {1, 7, kAll}) {
                for (const bool tighten : {false, true}) {
                    Settings settings = segments(layers, SegmentForm::Loop);
                    settings.lattice = lattice;
                    settings.tighten = tighten;
                    const FramePlan plan = decide(scene, settings);
                    SCOPED_TRACE(std::string(name(lattice)) + ", " + std::to_string(plan.planes) +
                                 (tighten ? " tight planes" : " planes"));
                    expectMatchesReference(draw(scene, plan, view, kSize), scene, plan, view,
                                           kMeanLimit);
                }
            }
        }
    }
};

/// Camera at `eye` (mm from the volume's centre), turned by angles about x, y and z.
View freeView(const Scene& scene, glm::dvec3 eye, glm::dvec3 degrees, double fovDegrees) {
    const glm::dvec3 place = scene.geometry().boundingSphere().centreMm + eye;
    glm::dmat4 turn(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 about(0.0);
        about[axis] = 1.0;
        turn = glm::rotate(turn, glm::radians(degrees[axis]), about);
    }
    return {.viewFromModel = turn * glm::translate(glm::dmat4(1.0), -place),
            .frustum = symmetricFrustum(fovDegrees, double(kSize.x) / kSize.y)};
}

int visiblePixels(const Picture& picture) {
    return static_cast<int>(std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                          [](glm::vec4 p) { return p != glm::vec4(0.0F); }));
}

} // namespace

TEST_F(ViewsTest, EyeInsideTheVolume) {
    const Scene scene = wavyScene(1);
    expectAllMatch(scene, freeView(scene, {3.0, -2.0, 4.0}, {20.0, 70.0, 10.0}, 80.0));
}

TEST_F(ViewsTest, EyeAtTheVeryCentre) {
    const Scene scene = wavyScene(2);
    expectAllMatch(scene, freeView(scene, glm::dvec3(0.0), {33.0, 12.0, 0.0}, 70.0));
}

TEST_F(ViewsTest, VolumeBehindTheEyeDrawsNothing) {
    const Scene scene = wavyScene(3);
    for (const double away : {1.01, 3.0, 50.0}) {
        View view = orbitView(scene, {15.0, 5.0, away}, 60.0, kSize);
        view.viewFromModel =
            glm::rotate(glm::dmat4(1.0), glm::radians(180.0), glm::dvec3(0.0, 1.0, 0.0)) *
            view.viewFromModel;
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            for (const bool tighten : {false, true}) {
                Settings settings = segments(7, SegmentForm::Loop);
                settings.lattice = lattice;
                settings.tighten = tighten;
                EXPECT_EQ(visiblePixels(draw(scene, settings, view, kSize)), 0)
                    << away << " radii, " << name(lattice);
            }
        }
    }
}

TEST_F(ViewsTest, VolumeLargerThanTheView) {
    const Scene scene = wavyScene(4);
    expectAllMatch(scene, orbitView(scene, {200.0, -30.0, 1.3}, 12.0, kSize));
}

TEST_F(ViewsTest, VolumeOfAFewPixels) {
    const Scene scene = wavyScene(5);
    expectAllMatch(scene, orbitView(scene, {60.0, 25.0, 30.0}, 40.0, kSize));
}

TEST_F(ViewsTest, OffAxisFrustum) {
    const Scene scene = wavyScene(6);
    View view = freeView(scene, {14.0, 6.0, 40.0}, glm::dvec3(0.0), 40.0);
    view.frustum = {-0.9, 0.2, -0.7, 0.1};
    expectAllMatch(scene, view);
}

TEST_F(ViewsTest, NearPlaneInsideTheVolume) {
    const Scene scene = wavyScene(7);
    View view = orbitView(scene, {120.0, 10.0, 1.8}, 60.0, kSize);
    for (const double radii : {1.4, 1.8, 2.2}) {
        view.nearDepth = radii * scene.geometry().boundingSphere().radiusMm;
        expectAllMatch(scene, view);
    }
}

TEST_F(ViewsTest, AnyRotationAndAScaledView) {
    for (std::uint64_t seed = 10; seed < 14; ++seed) {
        Random random(seed);
        const Scene scene = wavyScene(seed);
        const glm::dvec3 turn{random.in(-180.0, 180.0), random.in(-180.0, 180.0),
                              random.in(-180.0, 180.0)};
        View view = freeView(scene, glm::dvec3(0.0), turn, 50.0);
        // Metres instead of mm, as a headset's world has them.
        const glm::dmat4 away =
            glm::translate(glm::dmat4(1.0), {random.in(-5.0, 5.0), random.in(-5.0, 5.0), -45.0});
        view.viewFromModel =
            glm::scale(glm::dmat4(1.0), glm::dvec3(0.001)) * away * view.viewFromModel;
        expectAllMatch(scene, view);
    }
}

// What is skipped or tightened away must not depend on the near plane: a layer that it cuts may be
// sampled before it.
TEST_F(ViewsTest, TightPlanesChangeNothingAtTheNearPlane) {
    Random random(20);
    const Volume volume = makeVolume({24, 24, 24}, VoxelType::U8, [&](glm::ivec3) {
        return random.chance(0.004) ? 255.0 : 0.0;
    });
    const TransferFunction tf{
        .points = {{60.0, glm::dvec3(1.0), 0.0}, {255.0, glm::dvec3(1.0), 0.9}}};
    const Scene scene = makeScene(volume, {.tf = tf}, {.blockEdgeVoxels = 1});
    for (int k = 0; k < 40; ++k) {
        View view =
            freeView(scene, {random.in(-9.0, 9.0), random.in(-9.0, 9.0), random.in(-9.0, 9.0)},
                     {random.in(0.0, 360.0), random.in(0.0, 360.0), 0.0}, 90.0);
        view.nearDepth = random.oneOf({0.0, 0.4, 3.0});
        Settings settings = segments(random.oneOf({1, 5, kAll}), SegmentForm::Loop);
        settings.layerSpacingVoxels = random.oneOf({0.5, 2.0, 6.0});
        settings.lattice = random.oneOf({LatticeKind::Planar, LatticeKind::Shells});
        settings.tighten = false;
        const Picture plain = draw(scene, settings, view, kSize);
        settings.tighten = true;
        EXPECT_EQ(differingPixels(plain, draw(scene, settings, view, kSize)), 0)
            << k << ", " << name(*settings.lattice);
    }
}

// A far volume's outline falls between pixels, and the rasteriser rounds vertices to 1/256 pixel.
TEST_F(ViewsTest, TightPlanesLoseNoPixelOfAFarVolume) {
    Random random(40);
    const Scene scene = makeScene(constantVolume({128, 108, 96}, 9),
                                  {.tf = uniformTransfer(0.25, glm::dvec3(1.0))});
    for (int k = 0; k < 80; ++k) {
        const OrbitCamera camera{random.oneOf({0.0, 45.0, 90.0, 77.0}),
                                 random.oneOf({0.0, 10.0, 90.0}), random.in(20.0, 80.0)};
        Settings settings = segments(random.oneOf({4, kAll}), SegmentForm::Loop);
        settings.layerSpacingVoxels = random.oneOf({0.125, 0.5});
        settings.lattice = random.oneOf({LatticeKind::Planar, LatticeKind::Shells});
        settings.tighten = false;
        View view = orbitView(scene, camera, 20.0, kSize);
        view.frustum.left += random.in(-0.01, 0.01); // moves the outline through the pixels
        const Picture plain = draw(scene, settings, view, kSize);
        EXPECT_GT(visiblePixels(plain), 0);
        settings.tighten = true;
        EXPECT_EQ(differingPixels(plain, draw(scene, settings, view, kSize)), 0)
            << k << ", " << camera.distanceRadii;
    }
}

class StereoTest : public ViewsTest {
protected:
    static constexpr glm::ivec2 kEye{80, 64};

    /// Both eyes of a scene in the given framebuffers and viewports.
    void drawEyes(const Scene& scene, const FramePlan& plan, std::span<const ViewTarget> targets) {
        ASSERT_TRUE(renderer().prepare(scene, plan, targets).has_value());
        ASSERT_TRUE(renderer().draw(scene, plan, targets).has_value());
    }
    std::array<View, 2> eyesOf(const Scene& scene) {
        const View centre = orbitView(scene, {20.0, 15.0, 2.2}, 50.0, kEye);
        return stereoViews(centre, 6.0, 2.2 * scene.geometry().boundingSphere().radiusMm);
    }
};

TEST_F(StereoTest, EachEyeIsItsMonoPictureBitForBit) {
    const Scene scene = wavyScene(30, 0.5);
    const std::array<View, 2> eyes = eyesOf(scene);
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const int layers : {1, 9, kAll}) {
            Settings settings = segments(layers, SegmentForm::Loop);
            settings.lattice = lattice;
            const FramePlan plan = decide(scene, settings);
            const Picture mono[2] = {draw(scene, plan, eyes[0], kEye),
                                     draw(scene, plan, eyes[1], kEye)};
            EXPECT_GT(differingPixels(mono[0], mono[1]), 1000);

            gl::ColorTargets wide;
            ASSERT_TRUE(wide.resize(2 * kEye.x, kEye.y, {GL_RGBA16F}).has_value());
            wide.begin();
            const Viewport left{0, 0, kEye.x, kEye.y};
            const Viewport right{kEye.x, 0, kEye.x, kEye.y};
            const ViewTarget sideBySide[] = {{eyes[0], wide.framebuffer(), left},
                                             {eyes[1], wide.framebuffer(), right}};
            drawEyes(scene, plan, sideBySide);
            const Picture both{{2 * kEye.x, kEye.y}, wide.read()};
            EXPECT_EQ(differingPixels(both.part(left), mono[0]), 0)
                << name(lattice) << ' ' << plan.planes;
            EXPECT_EQ(differingPixels(both.part(right), mono[1]), 0)
                << name(lattice) << ' ' << plan.planes;

            gl::ColorTargets own[2];
            ViewTarget apart[2];
            for (int eye = 0; eye < 2; ++eye) {
                ASSERT_TRUE(own[eye].resize(kEye.x, kEye.y, {GL_RGBA16F}).has_value());
                own[eye].begin();
                apart[eye] = {eyes[eye], own[eye].framebuffer(), left};
            }
            drawEyes(scene, plan, apart);
            for (int eye = 0; eye < 2; ++eye) {
                EXPECT_EQ(differingPixels({kEye, own[eye].read()}, mono[eye]), 0)
                    << name(lattice) << ' ' << eye;
            }
        }
    }
}

/// Two eyes as layers 2 and 0 of an array of three, of level 1.
class ArrayTest : public StereoTest {
protected:
    static constexpr int kLevel = 1;

    void SetUp() override {
        StereoTest::SetUp();
        texture_ = gl::Texture::make("host's array", GL_TEXTURE_2D_ARRAY);
        reading_ = gl::Framebuffer::make("host's framebuffer");
        gl::BindTexture(GL_TEXTURE_2D_ARRAY, texture_.id());
        gl::TexStorage3D(GL_TEXTURE_2D_ARRAY, 2, GL_RGBA16F, 2 * kEye.x, 2 * kEye.y, 3);
        clear();
    }
    void clear() const {
        for (int layer = 0; layer < 3; ++layer) {
            const glm::vec4 nothing(0.0F);
            attach(layer);
            gl::ClearBufferfv(GL_COLOR, 0, &nothing.x);
        }
    }
    void attach(int layer) const {
        gl::BindFramebuffer(GL_FRAMEBUFFER, reading_.id());
        gl::FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture_.id(), kLevel,
                                    layer);
    }
    Picture read(int layer) const {
        attach(layer);
        gl::StateGuard::usePlainPacking();
        Picture picture{kEye, std::vector<glm::vec4>(std::size_t(kEye.x) * kEye.y)};
        gl::ReadPixels(0, 0, kEye.x, kEye.y, GL_RGBA, GL_FLOAT, picture.pixels.data());
        return picture;
    }
    ViewTarget layerOf(const View& view, int layer) const {
        return {.view = view,
                .viewport = {0, 0, kEye.x, kEye.y},
                .encoding = TargetEncoding::Encoded,
                .layer = TargetLayer{texture_.id(), layer, kLevel}};
    }

    gl::Texture texture_;
    gl::Framebuffer reading_;
};

TEST_F(ArrayTest, EachLayerIsItsMonoPictureBitForBit) {
    const Scene scene = wavyScene(31, 0.5);
    const std::array<View, 2> eyes = eyesOf(scene);
    for (const BlendOrder order : {BlendOrder::BackToFront, BlendOrder::FrontToBack}) {
        clear();
        Settings settings = segments(9, SegmentForm::Loop);
        settings.order = order;
        const FramePlan plan = decide(scene, settings);
        const ViewTarget targets[] = {layerOf(eyes[0], 2), layerOf(eyes[1], 0)};
        drawEyes(scene, plan, targets);
        EXPECT_EQ(differingPixels(read(2), draw(scene, plan, eyes[0], kEye)), 0) << name(order);
        EXPECT_EQ(differingPixels(read(0), draw(scene, plan, eyes[1], kEye)), 0) << name(order);
        EXPECT_EQ(visiblePixels(read(1)), 0) << "another layer than those";
        EXPECT_GT(visiblePixels(read(0)), 1000);
    }
}

// A texture is gone when its name is deleted only where no framebuffer has it attached.
TEST_F(ArrayTest, DrawingHoldsOnToNoTexture) {
    const Scene scene = wavyScene(32);
    const FramePlan plan = decide(scene, segments(9, SegmentForm::Loop));
    const ViewTarget target = layerOf(eyesOf(scene)[0], 1);
    static int attached;
    static decltype(gl::FramebufferTextureLayer) attachLayer;
    ASSERT_TRUE(renderer().prepare(scene, plan, {&target, 1}).has_value());
    attached = 0;
    attachLayer =
        std::exchange(gl::FramebufferTextureLayer,
                      [](GLenum to, GLenum point, GLuint texture, GLint level, GLint layer) {
                          attached += texture != 0 ? 1 : -1;
                          attachLayer(to, point, texture, level, layer);
                      });
    const bool drawn = renderer().draw(scene, plan, {&target, 1}).has_value();
    gl::FramebufferTextureLayer = attachLayer;
    EXPECT_TRUE(drawn);
    EXPECT_EQ(attached, 0);
    EXPECT_GT(visiblePixels(read(1)), 1000);
}

TEST_F(ArrayTest, WhatIsNoLayerIsRefused) {
    const Scene scene = wavyScene(33);
    const FramePlan plan = decide(scene, segments(9, SegmentForm::Loop));
    for (const TargetLayer& none : {TargetLayer{0, 0, 0}, TargetLayer{texture_.id(), -1, 0},
                                    TargetLayer{texture_.id(), 0, -1}}) {
        ViewTarget target = layerOf(eyesOf(scene)[0], 0);
        target.layer = none;
        const Result<void> prepared = renderer().prepare(scene, plan, {&target, 1});
        ASSERT_FALSE(prepared.has_value());
        EXPECT_EQ(prepared.error().code, ErrorCode::InvalidArgument);
        EXPECT_NE(prepared.error().detail.find("view 0: its layer"), std::string::npos)
            << prepared.error().detail;
    }
}

} // namespace slabcast::test

#include "core/view/view.h"

#include <gtest/gtest.h>

#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;

const BoundingSphere kSphere{{12.0, -30.0, 7.0}, 50.0};

glm::dvec3 inView(const glm::dmat4& viewFromModel, glm::dvec3 point) {
    return glm::dvec3(viewFromModel * glm::dvec4(point, 1.0));
}

void expectNear(glm::dvec3 a, glm::dvec3 b, double bound) {
    EXPECT_NEAR(glm::distance(a, b), 0.0, bound);
}

void expectNear(const Frustum& a, const Frustum& b, double bound) {
    EXPECT_NEAR(a.left, b.left, bound);
    EXPECT_NEAR(a.right, b.right, bound);
    EXPECT_NEAR(a.bottom, b.bottom, bound);
    EXPECT_NEAR(a.top, b.top, bound);
}

TEST(OrbitCamera, StandsWhereItSaysAndLooksAtTheCentre) {
    // LPS: x to the left, y to the back, z up. The picture's right and top as directions of the
    // patient.
    const struct {
        double azimuth, elevation;
        glm::dvec3 outward, right, top;
    } cases[] = {
        {0.0, 0.0, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}},   // the face; the patient's left on the right
        {90.0, 0.0, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},   // the left ear; the back on the right
        {180.0, 0.0, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, // the back of the head
        {0.0, 90.0, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},   // from above: the back on top
        {0.0, -90.0, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}} // from below: the face on top
    };
    for (const auto& c : cases) {
        const glm::dmat4 m = viewFromModel({c.azimuth, c.elevation, 2.5}, kSphere);
        const glm::dvec3 eye = kSphere.centreMm + 2.5 * 50.0 * c.outward;
        expectNear(inView(m, eye), glm::dvec3(0.0), 1e-12);
        expectNear(inView(m, kSphere.centreMm), {0.0, 0.0, -125.0}, 1e-12);
        expectNear(inView(m, eye + c.right), {1.0, 0.0, 0.0}, 1e-12);
        expectNear(inView(m, eye + c.top), {0.0, 1.0, 0.0}, 1e-12);
    }
}

TEST(OrbitCamera, IsARigidMotionAnywhere) {
    Dice dice(1);
    for (int k = 0; k < 1000; ++k) {
        const OrbitCamera camera{dice.uniform(-720.0, 720.0), dice.uniform(-90.0, 90.0),
                                 dice.logUniform(0.1, 1e6)};
        const glm::dmat4 m = viewFromModel(camera, kSphere);
        const glm::dmat3 axes(m);
        EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-14);
        for (int column = 0; column < 3; ++column) {
            const glm::dvec3 product = (glm::transpose(axes) * axes)[column];
            expectNear(product, glm::dmat3(1.0)[column], 1e-14);
        }
        const double az = camera.azimuthDegrees * M_PI / 180.0;
        const double el = camera.elevationDegrees * M_PI / 180.0;
        const glm::dvec3 outward(std::sin(az) * std::cos(el), -std::cos(az) * std::cos(el),
                                 std::sin(el));
        const double distance = camera.distanceRadii * 50.0;
        expectNear(inView(m, kSphere.centreMm + distance * outward), glm::dvec3(0.0),
                   1e-14 * (distance + 100.0));
        EXPECT_GE((axes * glm::dvec3(0.0, 0.0, 1.0)).y, -1e-15); // z never points down the picture
    }
}

TEST(Frustum, IsReadFromGlsMatrices) {
    Dice dice(2);
    for (int k = 0; k < 200; ++k) {
        const Frustum f = test::randomFrustum(dice);
        const double n = dice.logUniform(1e-3, 1e3);
        const glm::dmat4 m = glm::frustum(f.left * n, f.right * n, f.bottom * n, f.top * n, n,
                                          n * dice.logUniform(2.0, 1e5));
        const double widest = std::max({-f.left, f.right, -f.bottom, f.top});
        expectNear(frustumOf(m).value(), f, 1e-13 * widest);
        // The GL's own rule: the edges are what lands on -1 and +1.
        const glm::dvec4 corner = m * glm::dvec4(f.left * n, f.top * n, -n, 1.0);
        EXPECT_NEAR(corner.x / corner.w, -1.0, 1e-12);
        EXPECT_NEAR(corner.y / corner.w, 1.0, 1e-12);
    }
}

TEST(Frustum, SymmetricIsGlusPerspective) {
    for (const double fov : {1.0, 40.0, 90.0, 170.0}) {
        const Frustum f = symmetricFrustum(fov, 1.6);
        expectNear(frustumOf(glm::perspective(fov * M_PI / 180.0, 1.6, 0.1, 10.0)).value(), f,
                   1e-12);
        EXPECT_NEAR(std::atan(f.top) * 2.0 * 180.0 / M_PI, fov, 1e-12);
        EXPECT_EQ(f.left, -f.right);
        EXPECT_EQ(f.bottom, -f.top);
    }
}

TEST(Frustum, OfNoPerspectiveIsRefused) {
    const double nan = std::nan("");
    glm::dmat4 mirrored = glm::perspective(1.0, 1.6, 0.1, 10.0);
    mirrored[1][1] *= -1.0;
    glm::dmat4 broken = glm::perspective(1.0, 1.6, 0.1, 10.0);
    broken[2][0] = nan;
    for (const glm::dmat4& m : {glm::ortho(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0), glm::dmat4(1.0),
                                glm::dmat4(0.0), mirrored, broken}) {
        const Result<Frustum> frustum = frustumOf(m);
        ASSERT_FALSE(frustum.has_value());
        EXPECT_EQ(frustum.error().code, ErrorCode::InvalidArgument);
    }
}

TEST(View, OfWhichNoPictureCanBeMadeIsRefused) {
    const double nan = std::nan("");
    const View good{.viewFromModel = viewFromModel({30.0, 20.0, 3.0}, kSphere)};
    EXPECT_TRUE(check(good).has_value());
    const auto changed = [&](auto change) {
        View view = good;
        change(view);
        return view;
    };
    const View bad[] = {
        changed([=](View& v) { v.viewFromModel[1][2] = nan; }),
        changed([=](View& v) { v.viewFromModel[3][0] = HUGE_VAL; }),
        changed([](View& v) { v.viewFromModel = glm::dmat4(0.0); }),
        changed([](View& v) { v.viewFromModel[2] = v.viewFromModel[1]; }),
        changed([](View& v) { v.viewFromModel = glm::perspective(1.0, 1.0, 0.1, 10.0); }),
        changed([](View& v) { v.frustum.right = v.frustum.left; }),
        changed([](View& v) { std::swap(v.frustum.bottom, v.frustum.top); }),
        changed([=](View& v) { v.frustum.top = nan; }),
        changed([](View& v) { v.nearDepth = -1.0; }),
        changed([=](View& v) { v.nearDepth = nan; })};
    for (std::size_t k = 0; k < std::size(bad); ++k) {
        const Result<void> ok = check(bad[k]);
        ASSERT_FALSE(ok.has_value()) << k;
        EXPECT_EQ(ok.error().code, ErrorCode::InvalidArgument) << k;
    }
}

TEST(View, MayBeOfAnyUnitOfLength) {
    View view{.viewFromModel = viewFromModel({30.0, 20.0, 3.0}, kSphere)};
    for (const double scale : {1e-9, 1.0, 1e9}) {
        view.viewFromModel = glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) *
                             viewFromModel({30.0, 20.0, 3.0}, kSphere);
        EXPECT_TRUE(check(view).has_value()) << scale;
    }
}

TEST(Stereo, EyesAreParallelAndMeetAtTheDepthOfConvergence) {
    View centre;
    centre.viewFromModel = viewFromModel({30.0, 20.0, 3.0}, kSphere);
    centre.frustum = {-0.4, 0.5, -0.3, 0.35};
    centre.nearDepth = 2.0;
    const double ipd = 64.0;
    const double depth = 150.0;
    const std::array<View, 2> eyes = stereoViews(centre, ipd, depth);
    const double sides[] = {-1.0, 1.0}; // left first
    for (int eye = 0; eye < 2; ++eye) {
        const View& view = eyes[eye];
        // The same axes; the eye itself half the distance to its side.
        EXPECT_EQ(glm::dmat3(view.viewFromModel), glm::dmat3(centre.viewFromModel));
        const glm::dvec3 fromCentre(centre.viewFromModel * glm::inverse(view.viewFromModel) *
                                    glm::dvec4(0.0, 0.0, 0.0, 1.0));
        expectNear(fromCentre, {sides[eye] * ipd / 2.0, 0.0, 0.0}, 1e-11);
        EXPECT_EQ(view.nearDepth, centre.nearDepth);
        // At the depth of convergence both windows have the edges of the central one.
        EXPECT_NEAR(view.frustum.left * depth + fromCentre.x, centre.frustum.left * depth, 1e-11);
        EXPECT_NEAR(view.frustum.right * depth + fromCentre.x, centre.frustum.right * depth, 1e-11);
        EXPECT_EQ(view.frustum.bottom, centre.frustum.bottom);
        EXPECT_EQ(view.frustum.top, centre.frustum.top);
    }
}

TEST(Stereo, WithoutADistanceBothEyesAreTheCentralOne) {
    View centre;
    centre.viewFromModel = viewFromModel({}, kSphere);
    for (const View& eye : stereoViews(centre, 0.0, 100.0)) {
        EXPECT_EQ(eye.viewFromModel, centre.viewFromModel);
        expectNear(eye.frustum, centre.frustum, 0.0);
    }
}

} // namespace
} // namespace slabcast

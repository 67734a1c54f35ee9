// Two eyes into the layers of a texture array that the application owns, as headsets hand them out.
#include "host.h"

#include <cmath>

using namespace slabcast;

namespace {

constexpr int kSize = 128;
constexpr double kIpd = 64.0; // mm, as the volume is

/// A layer per eye of one texture.
struct Eyes {
    GLuint texture = 0;
    std::array<GLuint, 2> framebuffers{}; // the application's: to clear and to read
};

Eyes makeEyes(const Host& host) {
    Eyes eyes;
    host.GenTextures(1, &eyes.texture);
    host.BindTexture(GL_TEXTURE_2D_ARRAY, eyes.texture);
    host.TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, kSize, kSize, 2);
    host.GenFramebuffers(2, eyes.framebuffers.data());
    for (int eye = 0; eye < 2; ++eye) {
        host.BindFramebuffer(GL_FRAMEBUFFER, eyes.framebuffers[eye]);
        host.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, eyes.texture, 0, eye);
        host.clear(eyes.framebuffers[eye]);
    }
    return eyes;
}

/// Where the red lies, in pixels to the right of the middle.
double centreOf(const Host::Pixels& pixels) {
    double sum = 0.0;
    double weighted = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        sum += pixels[i][0];
        weighted += pixels[i][0] * (double(i % kSize) + 0.5 - kSize / 2.0);
    }
    return weighted / sum; // NaN of a black picture
}

} // namespace

int main() {
    const Host host;
    const Eyes target = makeEyes(host);
    const TransferFunction red{.name = "red",
                               .points = {{60.0, {1, 0, 0}, 0.0}, {100.0, {1, 0, 0}, 0.9}}};

    const Device device = orExit(Device::open(host.context.getProc()));
    Renderer renderer = orExit(Renderer::create(device));
    Scene scene = orExit(Scene::create(ballVolume(64), device));
    orExit(scene.setLook({.tf = red}));
    const FramePlan plan = orExit(renderer.plan(scene, Settings{}));

    const BoundingSphere sphere = scene.geometry().boundingSphere();
    const OrbitCamera camera{.distanceRadii = 8.0};
    const double distance = camera.distanceRadii * sphere.radiusMm;
    const View centre{viewFromModel(camera, sphere), symmetricFrustum(20.0, 1.0)};
    const std::array<View, 2> eyes = stereoViews(centre, kIpd, 2.0 * distance);
    const Viewport whole{0, 0, kSize, kSize};
    const ViewTarget targets[] = {
        {.view = eyes[0], .viewport = whole, .layer = TargetLayer{target.texture, 0}},
        {.view = eyes[1], .viewport = whole, .layer = TargetLayer{target.texture, 1}}};
    orExit(renderer.prepare(scene, plan, targets));
    orExit(renderer.draw(scene, plan, targets));

    // Nearer than where the eyes' windows meet, the ball lies to the right for the left eye.
    const double shift = kIpd / 2.0 * (1.0 / distance - 0.5 / distance);
    const double expected = shift / centre.frustum.right * kSize / 2.0;
    const double left = centreOf(host.read(target.framebuffers[0], kSize, kSize));
    const double right = centreOf(host.read(target.framebuffers[1], kSize, kSize));
    std::printf("left %.2f, right %.2f, expected %.2f pixels\n", left, right, expected);
    return std::abs(left - expected) < 0.5 && std::abs(right + expected) < 0.5 ? 0 : 1;
}

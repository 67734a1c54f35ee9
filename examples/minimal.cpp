// From a volume in memory to a picture in a framebuffer of the application's own.
#include "host.h"

using namespace slabcast;

namespace {

constexpr int kSize = 128;

/// Red in the middle, nothing in the corner.
bool isRight(const Host::Pixels& pixels) {
    const auto& middle = pixels[kSize / 2 * kSize + kSize / 2];
    const auto& corner = pixels.front();
    std::printf("middle %d %d %d, corner %d\n", middle[0], middle[1], middle[2], corner[0]);
    return middle[0] > 200 && middle[1] == 0 && middle[2] == 0 && corner[0] == 0;
}

} // namespace

int main() {
    const Host host; // its context is current
    const GLuint framebuffer = host.framebuffer(kSize, kSize);
    const TransferFunction red{.name = "red",
                               .points = {{60.0, {1, 0, 0}, 0.0}, {100.0, {1, 0, 0}, 0.9}}};

    const Device device = orExit(Device::open(host.context.getProc()));
    Renderer renderer = orExit(Renderer::create(device));
    Scene scene = orExit(Scene::create(ballVolume(64), device));
    orExit(scene.setLook({.tf = red}));
    const FramePlan plan = orExit(renderer.plan(scene, Settings{}));

    const View view{viewFromModel(OrbitCamera{}, scene.geometry().boundingSphere()),
                    symmetricFrustum(40.0, 1.0)};
    const ViewTarget target{view, framebuffer, {0, 0, kSize, kSize}};
    orExit(renderer.prepare(scene, plan, {&target, 1}));
    orExit(renderer.draw(scene, plan, {&target, 1}));

    return isRight(host.read(framebuffer, kSize, kSize)) ? 0 : 1;
}

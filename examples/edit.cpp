// A transfer function that changes in every frame, as under a hand that drags. Every picture is
// exact.
#include "host.h"

using namespace slabcast;

namespace {

constexpr int kSize = 128;
constexpr int kFrames = 40;
constexpr double kBudgetMs = 2.0; // of a frame, for making the next ones faster

/// A shell of values around `value`.
TransferFunction shellAt(double value) {
    const glm::dvec3 gold(1.0, 0.8, 0.3);
    return {.name = "shell",
            .points = {{value - 20.0, gold, 0.0}, {value, gold, 0.6}, {value + 20.0, gold, 0.0}}};
}

void draw(Renderer& renderer, const Scene& scene, const FramePlan& plan, const ViewTarget& target) {
    orExit(renderer.prepare(scene, plan, {&target, 1}));
    orExit(renderer.draw(scene, plan, {&target, 1}));
}

} // namespace

int main() {
    const Host host;
    const GLuint framebuffer = host.framebuffer(kSize, kSize);
    const Device device = orExit(Device::open(host.context.getProc()));
    Renderer renderer = orExit(Renderer::create(device));
    Scene scene = orExit(Scene::create(ballVolume(64), device));
    orExit(scene.setLook({.tf = shellAt(30.0)}));
    orExit(renderer.plan(scene, Settings{})); // provides what skips under the first one

    const View view{viewFromModel(OrbitCamera{}, scene.geometry().boundingSphere()),
                    symmetricFrustum(40.0, 1.0)};
    const ViewTarget target{view, framebuffer, {0, 0, kSize, kSize}};
    LiveScene live = orExit(LiveScene::start(scene));
    for (int frame = 0; frame < kFrames; ++frame) {
        if (frame < kFrames / 2) { // then the hand rests, and the faster structure is rebuilt
            orExit(live.edit(shellAt(30.0 + 8.0 * frame)));
        }
        const FramePlan plan = orExit(renderer.plan(live, Settings{}));
        host.clear(framebuffer);
        draw(renderer, live, plan, target);
        live.work(kBudgetMs);
    }
    const auto edited = host.read(framebuffer, kSize, kSize);

    // A scene that was never edited gives the same picture, bit for bit.
    orExit(scene.setLook({.tf = live.scene().look().tf}));
    const FramePlan plan = orExit(renderer.plan(scene, Settings{}));
    host.clear(framebuffer);
    draw(renderer, scene, plan, target);
    const auto& middle = edited[kSize / 2 * kSize + kSize / 2];
    std::printf("middle %d %d %d\n", middle[0], middle[1], middle[2]);
    return middle[0] > 100 && edited == host.read(framebuffer, kSize, kSize) ? 0 : 1;
}

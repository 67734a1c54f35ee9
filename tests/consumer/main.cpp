// Draws a phantom into a framebuffer of its own, with the installed package alone.
#include <array>

#include "core/draw/renderer.h"
#include "core/volume/phantoms.h"
#include "own_target.h"
#include "platform/egl/egl_context.h"

using namespace slabcast;

int main() {
    const EglContext context = orExit(EglContext::create());
    orExit(gl::loadApi(context.getProc()));
    const gl::Caps caps = orExit(gl::queryCaps());
    const OwnTarget target(64);

    const TransferFunction red{"red", "", 1.0, {{0.0, {1, 0, 0}, 0.0}, {255.0, {1, 0, 0}, 0.9}}};
    Scene scene = Scene::create(orExit(makePhantom("phantom:sphere:32")), TexelFormat::R8, 0.01);
    orExit(scene.setLook({.tf = red}, {}, 256));
    const FramePlan framePlan = orExit(plan(scene.facts(), {}, caps, {}));
    Renderer renderer = orExit(Renderer::create(caps));
    const View view{viewFromModel({}, scene.facts().sphere), symmetricFrustum(40.0, 1.0)};
    const std::array views{ViewTarget{view, target.framebuffer.id(), {0, 0, 64, 64}}};
    orExit(renderer.prepare(scene, framePlan, views));
    orExit(renderer.draw(scene, framePlan, views));

    gl::BindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.id());
    std::array<unsigned char, 4> middle{}, corner{};
    gl::ReadPixels(32, 32, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, middle.data());
    gl::ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, corner.data());
    std::printf("consumer: %s, middle %d %d %d\n", caps.renderer.c_str(), middle[0], middle[1],
                middle[2]);
    const bool redBall = middle[0] > 200 && middle[1] == 0 && middle[2] == 0;
    return redBall && corner[0] == 0 ? 0 : 1;
}

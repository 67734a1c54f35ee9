#include "perf/stability/turning.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

namespace slabcast::stability {

namespace {

constexpr OrbitCamera kCamera{30.0, 20.0, 2.5};
constexpr double kAsideDegrees = 20.0;
constexpr double kHalfFovDegrees = 20.0;

glm::dmat4 aside(double degrees) {
    return glm::rotate(glm::dmat4(1.0), glm::radians(kAsideDegrees + degrees), {0.0, 1.0, 0.0});
}

/// The window stays around the volume.
View lookingAside(const Scene& scene, const OrbitCamera& camera, double degrees) {
    const double angle = glm::radians(kAsideDegrees + degrees);
    const double half = glm::radians(kHalfFovDegrees);
    const double top = std::tan(half) / std::cos(angle);
    return {.viewFromModel =
                aside(degrees) * viewFromModel(camera, scene.geometry().boundingSphere()),
            .frustum = {std::tan(-half - angle), std::tan(half - angle), -top, top}};
}

} // namespace

std::vector<TurningScene> turningScenes() {
    return {{"steps",
             "phantom:shells:48",
             {.points = {{127.5, {0.9, 0.6, 0.3}, 0.0},
                         {127.5, {0.9, 0.6, 0.3}, 0.05},
                         {212.5, {0.9, 0.6, 0.3}, 0.05},
                         {212.5, {0.3, 0.5, 1.0}, 0.12}}},
             true},
            {"smooth",
             "phantom:marschner-lobb:48",
             {.points = {{0.3, {0.2, 0.4, 0.9}, 0.0},
                         {0.5, {0.9, 0.8, 0.3}, 0.06},
                         {0.9, {0.9, 0.3, 0.2}, 0.03}}},
             false}};
}

std::vector<double> turnedDegrees(bool reduced) {
    return reduced ? std::vector{0.1, 1.0} : std::vector{0.01, 0.03, 0.1, 0.3, 1.0};
}

View headTurned(const Scene& scene, double degrees) {
    return lookingAside(scene, kCamera, degrees);
}

View volumeTurned(const Scene& scene, double degrees) {
    OrbitCamera camera = kCamera;
    camera.azimuthDegrees += degrees;
    return lookingAside(scene, camera, 0.0);
}

glm::dmat3 headTurn(double degrees) {
    return glm::dmat3(aside(degrees));
}

double halfWindow() {
    return std::tan(glm::radians(kHalfFovDegrees));
}

DiscreteInput samplesOf(const Scene& scene, const View& view, glm::ivec2 size,
                        const Lattice& lattice) {
    return {.texels = &scene.texels(),
            .geometry = scene.geometry(),
            .transfer = scene.look().tf,
            .view = view,
            .viewport = {0, 0, size.x, size.y},
            .lattice = lattice};
}

double largest(glm::dvec4 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
}

} // namespace slabcast::stability

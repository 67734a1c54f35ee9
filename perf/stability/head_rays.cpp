#include "perf/stability/head_rays.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "core/base/parallel.h"
#include "core/reference/continuous.h"
#include "perf/stability/turning.h"

namespace slabcast::stability {

namespace {

/// Before a cube, a tenth of its edge from the nearest face.
constexpr OrbitCamera kClose{30.0, 20.0, 0.8};
constexpr Viewport kOnePixel{0, 0, 1, 1};
constexpr int kRaysAtOnce = 16;

glm::dmat4 turnedBy(double degrees) {
    return glm::rotate(glm::dmat4(1.0), glm::radians(degrees), {0.0, 1.0, 0.0});
}

} // namespace

const char* name(Region region) {
    constexpr const char* kNames[] = {"whole view", "centre", "border"};
    return kNames[static_cast<int>(region)];
}

HeadRays::HeadRays(const Scene& scene, double fovDegrees, int side)
    : scene_(scene), straight_{.viewFromModel =
                                   viewFromModel(kClose, scene.geometry().boundingSphere()),
                               .frustum = symmetricFrustum(fovDegrees, 1.0)} {
    for (int i = 0; i < side * side; ++i) {
        const glm::dvec2 share = (glm::dvec2(i % side, i / side) + 0.5) / double(side);
        tangents_.push_back((share * 2.0 - 1.0) * straight_.frustum.right);
        const EyeRay ray =
            eyeRayOf(viewOf(count() - 1, 0.0), kOnePixel, scene.geometry(), {0.5, 0.5});
        if (!(ray.entryMm < ray.exitMm)) {
            tangents_.pop_back();
        }
    }
    share_ = double(count()) / (double(side) * side);
}

bool HeadRays::isIn(Region region, int ray) const {
    const glm::dvec2 place = glm::abs(tangents_[std::size_t(ray)]) / straight_.frustum.right;
    const double outer = std::max(place.x, place.y);
    return region == Region::All ||
           (region == Region::Centre ? outer < 1.0 / 3.0 : outer > 2.0 / 3.0);
}

View HeadRays::viewOf(int ray, double turnedDegrees) const {
    const glm::dmat4 turn = turnedBy(turnedDegrees);
    const glm::dvec3 direction = glm::dmat3(turn) * glm::dvec3(tangents_[std::size_t(ray)], -1.0);
    const glm::dvec2 tangent = glm::dvec2(direction) / -direction.z;
    constexpr double kWidth = 1e-3;
    return {.viewFromModel = turn * straight_.viewFromModel,
            .frustum = {tangent.x - kWidth, tangent.x + kWidth, tangent.y - kWidth,
                        tangent.y + kWidth}};
}

Gathered HeadRays::gathered(const Lattice& lattice, double turnedDegrees) const {
    Gathered all{std::vector<glm::dvec4>(tangents_.size()), std::vector<EyeRay>(tangents_.size())};
    parallelFor(count(), kRaysAtOnce, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            const View view = viewOf(int(i), turnedDegrees);
            all.pixels[std::size_t(i)] =
                renderDiscrete(samplesOf(scene_, view, glm::ivec2(1), lattice)).front();
            all.rays[std::size_t(i)] = eyeRayOf(view, kOnePixel, scene_.geometry(), {0.5, 0.5});
        }
    });
    return all;
}

std::vector<glm::dvec4> HeadRays::integrals() const {
    std::vector<glm::dvec4> pixels(tangents_.size());
    parallelFor(count(), kRaysAtOnce, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            pixels[std::size_t(i)] = integrateRay({.texels = &scene_.texels(),
                                                   .geometry = scene_.geometry(),
                                                   .tf = scene_.look().tf,
                                                   .view = viewOf(int(i), 0.0),
                                                   .viewport = kOnePixel,
                                                   .tolerance = 1e-8},
                                                  glm::dvec2(0.5));
        }
    });
    return pixels;
}

} // namespace slabcast::stability

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/view/lattice.h"
#include "core/view/view.h"
#include "core/volume/volume.h"

namespace slabcast::test {

/// Reproducible randomness: the same on every machine, whatever its standard library's
/// distributions.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double logUniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
    bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
    glm::dvec3 inCube(double low, double high) {
        const double x = uniform(low, high);
        const double y = uniform(low, high);
        return {x, y, uniform(low, high)};
    }
    glm::dvec3 direction() {
        const double z = uniform(-1.0, 1.0);
        const double angle = uniform(0.0, 2.0 * M_PI);
        const double r = std::sqrt(1.0 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    glm::dmat3 rotation() {
        return glm::mat3_cast(glm::angleAxis(uniform(0.0, 2.0 * M_PI), direction()));
    }

private:
    std::mt19937_64 engine_;
};

/// A box of voxels, a view of it and the layers between.
struct FrameScene {
    VolumeGeometry geometry;
    View view;
    Viewport viewport;
    Lattice lattice;

    RayFrame frame() const { return makeRayFrame(view, viewport, geometry, lattice); }
    /// (x, y)/depth of a position in the target, from the frustum's edges alone.
    glm::dvec2 tangentAt(glm::dvec2 fragCoord) const {
        const Frustum& f = view.frustum;
        return {f.left + (f.right - f.left) * (fragCoord.x - viewport.x) / viewport.width,
                f.bottom + (f.top - f.bottom) * (fragCoord.y - viewport.y) / viewport.height};
    }
    glm::dvec2 tangentPerPixel() const { return tangentAt({1.0, 1.0}) - tangentAt({0.0, 0.0}); }
    glm::dvec2 fragCoordOf(glm::dvec2 tangent) const {
        const Frustum& f = view.frustum;
        return {viewport.x + viewport.width * (tangent.x - f.left) / (f.right - f.left),
                viewport.y + viewport.height * (tangent.y - f.bottom) / (f.top - f.bottom)};
    }
};

inline VolumeGeometry randomGeometry(Dice& dice) {
    VolumeGeometry geometry;
    for (int k = 0; k < 3; ++k) {
        geometry.dims[k] = 1 + dice.below(40);
        geometry.spacingMm[k] = dice.logUniform(0.3, 3.0);
    }
    geometry.originMm = dice.inCube(-200.0, 200.0);
    geometry.direction = dice.rotation();
    if (dice.chance(0.25)) { // mirrored and sheared, as a gantry's tilt makes it
        geometry.direction[2] =
            -glm::normalize(geometry.direction[2] + 0.3 * geometry.direction[1]);
    }
    return geometry;
}

/// Any off-axis frustum with a field of view of 1 to 170 degrees in each direction.
inline Frustum randomFrustum(Dice& dice) {
    const Frustum f = symmetricFrustum(dice.logUniform(1.0, 170.0), dice.logUniform(0.5, 2.0));
    const glm::dvec2 shift(dice.uniform(-0.9, 0.9) * f.right, dice.uniform(-0.9, 0.9) * f.top);
    return dice.chance(0.3)
               ? f
               : Frustum{f.left + shift.x, f.right + shift.x, f.bottom + shift.y, f.top + shift.y};
}

/// Where the sphere's centre lies in view space: at the eye, inside, close by, far away; mostly in
/// sight.
inline glm::dvec3 randomPlace(Dice& dice, const Frustum& f, double radius) {
    const double distances[] = {0.0, dice.uniform(0.0, 1.0), dice.uniform(1.0, 1.1),
                                dice.uniform(1.0, 6.0), dice.logUniform(5.0, 1e6)};
    const glm::dvec3 inSight =
        glm::normalize(glm::dvec3(dice.uniform(1.3 * f.left, 1.3 * f.right),
                                  dice.uniform(1.3 * f.bottom, 1.3 * f.top), -1.0));
    const double distance = distances[dice.below(5)] * radius;
    return distance * (dice.chance(0.8) ? inSight : dice.direction());
}

/// Any view that the library promises to draw: any rotation and scale, any place of the eye, near
/// plane anywhere.
inline FrameScene randomScene(Dice& dice, int totalLayers) {
    FrameScene scene;
    scene.geometry = randomGeometry(dice);
    const BoundingSphere sphere = scene.geometry.boundingSphere();
    const double scale = dice.chance(0.7) ? 1.0 : dice.logUniform(1e-3, 1e3);
    const double radius = sphere.radiusMm * scale;
    scene.view.frustum = randomFrustum(dice);
    const glm::dvec3 place = randomPlace(dice, scene.view.frustum, radius);
    const glm::dmat3 axes = dice.rotation() * scale;
    scene.view.viewFromModel = glm::dmat4(axes);
    scene.view.viewFromModel[3] = glm::dvec4(place - axes * sphere.centreMm, 1.0);
    const double nears[] = {0.0, 1e-3 * radius, dice.uniform(0.0, 2.0) * radius,
                            std::max(0.0, -place.z + dice.uniform(-1.0, 1.0) * radius)};
    scene.view.nearDepth = nears[dice.below(4)];
    scene.viewport = {dice.below(200), dice.below(200), 1 + dice.below(2000), 1 + dice.below(2000)};
    const bool jittered = totalLayers > 1 && dice.chance(0.3);
    const int covering = totalLayers - (jittered ? 1 : 0);
    scene.lattice = {dice.chance(0.5) ? LatticeKind::Planar : LatticeKind::Shells, totalLayers,
                     2.0 * sphere.radiusMm / covering *
                         (dice.chance(0.5) ? 1.0 : dice.uniform(1.0, 1.5)),
                     jittered};
    return scene;
}

/// A place in the target: anywhere, or where a point of the box is seen, were it ever so small.
inline glm::dvec2 randomFragCoord(Dice& dice, const FrameScene& scene) {
    const Viewport& v = scene.viewport;
    const glm::dvec4 uvw(dice.inCube(0.0, 1.0), 1.0);
    const glm::dvec3 point(scene.view.viewFromModel * scene.geometry.modelFromUvw() * uvw);
    const glm::dvec2 seen = scene.fragCoordOf(glm::dvec2(point) / -point.z);
    const bool inside = point.z < 0.0 && seen.x >= v.x && seen.x <= v.x + v.width &&
                        seen.y >= v.y && seen.y <= v.y + v.height;
    return inside && dice.chance(0.8)
               ? seen
               : glm::dvec2(v.x + dice.uniform(0.0, v.width), v.y + dice.uniform(0.0, v.height));
}

/// Length of a pixel's ray inside the box and beyond the near plane, from the matrices alone, in
/// extended precision. The box is grown by `growMm` on every side, or shrunk; the near plane moves
/// likewise.
inline double lengthInsideMm(const FrameScene& scene, glm::dvec2 fragCoord, double growMm = 0.0) {
    using Real = long double;
    using Vec3 = glm::vec<3, Real>;
    using Vec4 = glm::vec<4, Real>;
    const glm::mat<4, 4, Real> modelFromView =
        glm::inverse(glm::mat<4, 4, Real>(scene.view.viewFromModel));
    const glm::mat<4, 4, Real> uvwFromModel(
        glm::inverse(glm::mat<4, 4, Real>(scene.geometry.modelFromUvw())));
    const glm::dvec2 tangent = scene.tangentAt(fragCoord);
    const Vec3 perDepthMm(modelFromView * Vec4(tangent.x, tangent.y, -1.0, 0.0));
    const Vec3 eye(uvwFromModel * modelFromView * Vec4(0.0, 0.0, 0.0, 1.0));
    const Vec3 perDepth = Vec3(uvwFromModel * Vec4(perDepthMm, 0.0));
    const glm::mat<3, 3, Real> rows = glm::transpose(glm::mat<3, 3, Real>(uvwFromModel));
    const Real viewUnitsPerMm = glm::length(glm::dvec3(scene.view.viewFromModel[0]));
    Real begin = std::max(0.0L, scene.view.nearDepth - growMm * viewUnitsPerMm);
    Real end = std::numeric_limits<Real>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Real grow = growMm * glm::length(rows[k]);
        const Real low = (-grow - eye[k]) / perDepth[k];
        const Real high = (1.0L + grow - eye[k]) / perDepth[k];
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
    }
    return static_cast<double>(std::max(0.0L, end - begin) * glm::length(perDepthMm));
}

} // namespace slabcast::test

#include "core/view/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slabcast {

namespace {

constexpr int kMaxLayers = 1 << 22;

/// Offsets at which centre + o * step lies in [0,1] along every axis.
glm::dvec2 boxOffsets(glm::dvec3 centre, glm::dvec3 step) {
    glm::dvec2 range(-std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity());
    for (int k = 0; k < 3; ++k) {
        if (step[k] == 0.0) {
            if (centre[k] < 0.0 || centre[k] > 1.0) {
                return {1.0, 0.0};
            }
            continue;
        }
        const double a = (0.0 - centre[k]) / step[k];
        const double b = (1.0 - centre[k]) / step[k];
        range.x = std::max(range.x, std::min(a, b));
        range.y = std::min(range.y, std::max(a, b));
    }
    return range;
}

} // namespace

const char* name(LatticeKind kind) {
    return kind == LatticeKind::Planar ? "planar" : "shells";
}

double jitterOf(glm::ivec2 pixel) {
    // 0.06711056 and 0.00583715 in units of 2^-32; then 52.98 times the upper 24 bits, modulo 1.
    const std::uint32_t sum =
        std::uint32_t(pixel.x) * 288237660U + std::uint32_t(pixel.y) * 25070368U;
    const std::uint32_t noise = (sum >> 8) * 13564U;
    return std::ldexp(static_cast<double>(noise >> 8), -24) - 0.5;
}

int layersToCover(double radiusMm, double spacingMm) {
    // The relative slack keeps 2R/s = 444 from becoming 445 by rounding.
    const double layers = std::ceil(2.0 * radiusMm / spacingMm * (1.0 - 1e-12));
    return static_cast<int>(std::clamp(layers, 1.0, static_cast<double>(kMaxLayers)));
}

RayFrame makeRayFrame(const View& view, const Viewport& viewport, const VolumeGeometry& geometry,
                      const Lattice& lattice) {
    const BoundingSphere sphere = geometry.boundingSphere();
    const double viewUnitsPerMm =
        std::cbrt(std::abs(glm::determinant(glm::dmat3(view.viewFromModel))));
    const glm::dvec3 centreInView =
        glm::dvec3(view.viewFromModel * glm::dvec4(sphere.centreMm, 1.0));

    RayFrame frame;
    frame.lattice = lattice;
    frame.mmPerViewUnit = 1.0 / viewUnitsPerMm;
    frame.radius = sphere.radiusMm * viewUnitsPerMm;
    frame.spacing = lattice.spacingMm * viewUnitsPerMm;
    frame.nearDepth = view.nearDepth;
    frame.sphereCentre = {centreInView.x, centreInView.y, -centreInView.z};
    frame.sphereDistance = glm::length(centreInView);
    frame.viewportCorner = {viewport.x, viewport.y};
    frame.viewportCentre = {viewport.x + viewport.width / 2.0, viewport.y + viewport.height / 2.0};
    const Frustum& f = view.frustum;
    frame.tangent0 = {(f.left + f.right) / 2.0, (f.bottom + f.top) / 2.0};
    frame.tangentPerPixel = {(f.right - f.left) / viewport.width,
                             (f.top - f.bottom) / viewport.height};

    const glm::dmat3 uvwFromModel(geometry.uvwFromModel());
    const glm::dmat3 uvwFromView = uvwFromModel * glm::inverse(glm::dmat3(view.viewFromModel));
    const double depth = frame.sphereCentre.z;
    frame.direction0 = uvwFromView * glm::dvec3(frame.tangent0, -1.0);
    frame.directionX = uvwFromView * glm::dvec3(frame.tangentPerPixel.x, 0.0, 0.0);
    frame.directionY = uvwFromView * glm::dvec3(0.0, frame.tangentPerPixel.y, 0.0);
    // Relative to the sphere's centre, which stays near the box however far the eye: no
    // cancellation.
    const glm::dvec3 centreUvw =
        glm::dvec3(geometry.uvwFromModel() * glm::dvec4(sphere.centreMm, 1.0));
    const glm::dvec3 lateral(frame.tangent0.x * depth - frame.sphereCentre.x,
                             frame.tangent0.y * depth - frame.sphereCentre.y, 0.0);
    frame.centre0 = centreUvw + uvwFromView * lateral;
    frame.centreX = frame.directionX * depth;
    frame.centreY = frame.directionY * depth;
    return frame;
}

bool liesBeyondNear(const RayFrame& frame, const Frustum& frustum) {
    const double layers = frame.lattice.total / 2.0 + (frame.lattice.jittered ? 0.5 : 0.0);
    const double reach = layers * frame.spacing;
    if (frame.lattice.kind == LatticeKind::Planar) {
        return frame.sphereCentre.z - reach >= frame.nearDepth;
    }
    const double x = std::max(std::abs(frustum.left), std::abs(frustum.right));
    const double y = std::max(std::abs(frustum.bottom), std::abs(frustum.top));
    const double longest = std::sqrt(1.0 + x * x + y * y); // per unit of depth
    return frame.sphereCentre.z > 0.0 && frame.sphereDistance - reach >= frame.nearDepth * longest;
}

LatticeRay rayAt(const RayFrame& frame, glm::dvec2 fragCoord) {
    const glm::dvec2 p = fragCoord - frame.viewportCentre;
    const glm::dvec2 tangent = frame.tangent0 + frame.tangentPerPixel * p;
    const double lengthPerDepth = std::sqrt(1.0 + glm::dot(tangent, tangent));
    const glm::dvec3 direction = frame.direction0 + frame.directionX * p.x + frame.directionY * p.y;
    const double depth = frame.sphereCentre.z;

    LatticeRay ray;
    ray.centre = frame.centre0 + frame.centreX * p.x + frame.centreY * p.y;
    double nearOffset = 0.0;
    if (frame.lattice.kind == LatticeKind::Planar) {
        ray.step = direction * frame.spacing;
        ray.layerLengthMm = frame.spacing * lengthPerDepth * frame.mmPerViewUnit;
        nearOffset = (frame.nearDepth - depth) / frame.spacing;
    } else {
        const glm::dvec3 perLength = direction / lengthPerDepth;
        const double toShell = frame.sphereDistance - depth * lengthPerDepth;
        ray.centre += perLength * toShell;
        ray.step = perLength * frame.spacing;
        ray.layerLengthMm = frame.spacing * frame.mmPerViewUnit;
        nearOffset = (frame.nearDepth * lengthPerDepth - frame.sphereDistance) / frame.spacing;
    }
    if (frame.lattice.jittered) {
        const double jitter = jitterOf(glm::ivec2(glm::floor(fragCoord - frame.viewportCorner)));
        ray.centre += jitter * ray.step;
        nearOffset -= jitter;
    }
    const glm::dvec2 box = boxOffsets(ray.centre, ray.step);
    ray.entry = std::max(box.x, nearOffset);
    ray.exit = box.y;
    return ray;
}

LayerRange layersOf(const LatticeRay& ray, int total) {
    if (!(ray.entry < ray.exit)) {
        return {};
    }
    const double half = total / 2.0;
    const double begin = std::clamp(std::floor(ray.entry + half), 0.0, static_cast<double>(total));
    const double end = std::clamp(std::ceil(ray.exit + half), 0.0, static_cast<double>(total));
    return {static_cast<int>(begin), static_cast<int>(end)};
}

double layerWeight(const LatticeRay& ray, int total, int index) {
    const double lower = index - total / 2.0;
    return std::clamp(std::min(ray.exit, lower + 1.0) - std::max(ray.entry, lower), 0.0, 1.0);
}

glm::dvec3 samplePosition(const LatticeRay& ray, int total, int index) {
    return ray.centre + (index - total / 2.0 + 0.5) * ray.step;
}

} // namespace slabcast

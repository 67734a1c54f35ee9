#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "perf/stability/exhibit.h"
#include "perf/stability/extreme_views.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "extreme-views";
constexpr glm::ivec3 kDims(20, 16, 24);
constexpr glm::dvec3 kSpacing(1.0, 1.25, 0.75);
constexpr double kSigma = 0.0625; // exact in the table's fp16
constexpr glm::dvec3 kColor(1.0, 0.5, 0.25);

/// Nested shells off the middle, a bright voxel at each corner, air between: something wherever a
/// ray may start, and blocks to be skipped.
double shells(glm::ivec3 v) {
    const glm::ivec3 low = glm::min(v, kDims - 1 - v);
    if (low.x + low.y + low.z <= 1) {
        return 230.0;
    }
    const double r = glm::length((glm::dvec3(v) - glm::dvec3(10.5, 7.0, 12.0)) * kSpacing);
    return r < 6.0 ? 140.0 + 100.0 * std::cos(1.3 * r) : std::max(0.0, 70.0 * (7.0 - r));
}

TransferFunction bands() {
    return {.name = "bands",
            .points = {{30.0, {0.1, 0.3, 0.9}, 0.0},
                       {90.0, {0.2, 0.8, 0.4}, 0.15},
                       {140.0, {0.9, 0.9, 0.2}, 0.02},
                       {200.0, {0.9, 0.4, 0.1}, 0.3},
                       {255.0, {1.0, 0.9, 0.8}, 0.5}}};
}

struct ViewCase {
    std::string name;
    View view;
    glm::ivec2 size;
    int columnStride = 1;
};

glm::dvec3 modelAt(const VolumeGeometry& geometry, glm::dvec3 uvw) {
    return glm::dvec3(geometry.modelFromUvw() * glm::dvec4(uvw, 1.0));
}

View lookingFrom(glm::dvec3 eyeMm, glm::dvec3 forward, double fovDegrees, glm::ivec2 size) {
    const glm::dvec3 up = std::abs(glm::normalize(forward).z) > 0.99 ? glm::dvec3(0.0, 1.0, 0.0)
                                                                     : glm::dvec3(0.0, 0.0, 1.0);
    return {.viewFromModel = glm::lookAt(eyeMm, eyeMm + forward, up),
            .frustum = symmetricFrustum(fovDegrees, double(size.x) / size.y)};
}

/// The volume `depthRadii` deep, off the view axis by the tangents, in the middle of a frustum of
/// half width `reach` (tangent).
View offAxis(const Scene& scene, double depthRadii, glm::dvec2 tangent, double reach,
             glm::ivec2 size) {
    const BoundingSphere sphere = scene.geometry().boundingSphere();
    View view = orbitView(scene, {25.0, 15.0, depthRadii}, 40.0, size);
    const glm::dvec3 centre = glm::dvec3(tangent, -1.0) * (depthRadii * sphere.radiusMm);
    view.viewFromModel[3] =
        glm::dvec4(centre - glm::dmat3(view.viewFromModel) * sphere.centreMm, 1.0);
    const double high = reach * size.y / size.x;
    view.frustum = {tangent.x - reach, tangent.x + reach, tangent.y - high, tangent.y + high};
    return view;
}

/// Such that the whole sphere is in view, with a margin, from afar.
double fovAround(double distanceRadii) {
    return glm::degrees(2.4 / distanceRadii);
}

std::vector<ViewCase> eyesInAndOn(const Scene& scene, glm::ivec2 size) {
    struct Eye {
        const char* name;
        glm::dvec3 uvw;
        glm::dvec3 forward;
    };
    const glm::dvec3 voxel(1.0 / glm::dvec3(kDims));
    const Eye eyes[] = {
        {"eye at a voxel's centre", (glm::dvec3(10, 3, 12) + 0.5) * voxel, {0.3, 1.0, 0.2}},
        {"eye at a voxel's corner, along an axis", glm::dvec3(10, 8, 4) * voxel, {0, 0, 1}},
        {"eye at the very centre", glm::dvec3(0.5), {1.0, 0.0, 0.0}},
        {"eye on a face", {0.5, 0.0, 0.5}, {0.2, 1.0, 0.1}},
        {"eye on a face, looking along it", {0.5, 0.0, 0.5}, {1.0, 0.0, 0.0}},
        {"eye on an edge", {0.0, 0.0, 0.5}, {1.0, 1.0, 0.1}},
        {"eye on an edge, looking along it", {0.0, 0.0, 0.1}, {0.0, 0.0, 1.0}},
        {"eye at a corner", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}},
        {"eye at a corner, looking along an edge", {1.0, 1.0, 1.0}, {-1.0, 0.0, 0.0}}};
    std::vector<ViewCase> cases;
    for (const Eye& eye : eyes) {
        cases.push_back({eye.name,
                         lookingFrom(modelAt(scene.geometry(), eye.uvw), eye.forward, 75.0, size),
                         size});
    }
    cases.push_back(
        {"eye at the bounding sphere", orbitView(scene, {30, 20, 1.0}, 60.0, size), size});
    return cases;
}

std::vector<ViewCase> farAndWide(const Scene& scene, glm::ivec2 size) {
    const double far = 1e6;
    const glm::dvec3 inside = modelAt(scene.geometry(), {0.45, 0.2, 0.6});
    return {{"1e6 radii away, off axis", offAxis(scene, far, {0.4, -0.3}, 1.6 / far, size), size},
            {"1e6 radii away", orbitView(scene, {30, 20, far}, fovAround(far), size), size},
            {"field of view of 1 degree", orbitView(scene, {30, 20, 2.5}, 1.0, size), size},
            {"field of view of 170 degrees", orbitView(scene, {30, 20, 1.05}, 170.0, size), size},
            {"170 degrees from inside", lookingFrom(inside, {0.1, 1.0, 0.1}, 170.0, size), size},
            {"off axis by 58 degrees", offAxis(scene, 2.5, {1.6, 0.4}, 1.2, size), size},
            {"off axis by 82 degrees", offAxis(scene, 2.5, {6.5, -2.0}, 5.0, size), size}};
}

std::vector<ViewCase> axesAndDiagonals(const Scene& scene, glm::ivec2 size) {
    struct Axis {
        const char* name;
        double azimuth, elevation;
    };
    const double slope = glm::degrees(std::atan(std::sqrt(0.5)));
    const Axis axes[] = {{"along +y", 0, 0},         {"along -x", 90, 0},
                         {"along -y", 180, 0},       {"along +x", 270, 0},
                         {"along -z", 0, 90},        {"along +z", 0, -90},
                         {"diagonal 1", 45, slope},  {"diagonal 2", 135, slope},
                         {"diagonal 3", 225, slope}, {"diagonal 4", 315, slope}};
    std::vector<ViewCase> cases;
    for (const Axis& axis : axes) {
        cases.push_back(
            {axis.name, orbitView(scene, {axis.azimuth, axis.elevation, 2.5}, 50.0, size), size});
    }
    return cases;
}

std::vector<ViewCase> nearPlanesAndTargets(const Scene& scene, glm::ivec2 size) {
    const double radius = scene.geometry().boundingSphere().radiusMm;
    std::vector<ViewCase> cases;
    for (const double radii : {2.1, 2.5, 2.7}) {
        View view = orbitView(scene, {30, 20, 2.5}, 50.0, size);
        view.nearDepth = radii * radius;
        char name[64];
        std::snprintf(name, sizeof name, "near plane %.1f radii deep in the volume", radii - 1.5);
        cases.push_back({name, view, size});
    }
    const glm::ivec2 one(1, 1);
    cases.push_back({"target of 1x1", orbitView(scene, {30, 20, 2.5}, 20.0, one), one});
    const glm::ivec2 wide(4096, 16);
    View strip = orbitView(scene, {30, 20, 2.5}, 12.0, wide);
    strip.frustum.left = -0.45;
    strip.frustum.right = 0.45;
    cases.push_back({"target of 4096x16", strip, wide, 61});
    return cases;
}

/// Every view, or a few of each kind.
std::vector<ViewCase> allViews(const Scene& scene, bool reduced) {
    const glm::ivec2 size = reduced ? glm::ivec2(25, 19) : glm::ivec2(65, 49); // odd: a ray at 0
    std::vector<ViewCase> all;
    for (auto* const group :
         {&eyesInAndOn, &farAndWide, &axesAndDiagonals, &nearPlanesAndTargets}) {
        const std::vector<ViewCase> cases = (*group)(scene, size);
        for (std::size_t i = 0; i < cases.size(); i += reduced ? 5 : 1) {
            all.push_back(cases[i]);
        }
    }
    return all;
}

Exhibit exhibitOf(const Scene& scene, const ViewCase& c, LatticeKind lattice) {
    return {.family = kFamily,
            .name = c.name + ", " + name(lattice),
            .scene = scene,
            .view = c.view,
            .size = c.size,
            .lattice = lattice,
            .columnStride = c.columnStride};
}

/// Few pixels and fine layers, so that sampling's bound leaves something to be judged.
void integralCases(Bench& bench, const Scene& scene) {
    const glm::ivec2 size = bench.reduced() ? glm::ivec2(9, 7) : glm::ivec2(25, 19);
    for (auto* const group : {&eyesInAndOn, &farAndWide}) {
        const std::vector<ViewCase> cases = (*group)(scene, size);
        for (std::size_t i = 0; i < cases.size(); i += bench.reduced() ? 5 : 1) {
            for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
                Exhibit exhibit = exhibitOf(scene, cases[i], lattice);
                exhibit.layerSpacingVoxels = 1.0 / 8.0;
                recordAgainstIntegral(bench, exhibit);
            }
        }
    }
}

} // namespace

void extremeViewCases(Bench& bench) {
    const Volume volume = formulaVolume(kDims, VoxelType::U8, shells, kSpacing);
    const Result<Scene> structured =
        bench.scene(volume, {.tf = bands()}, {.blockEdgeVoxels = 2}, true);
    const Result<Scene> uniform =
        bench.scene(volume, {.tf = uniformTransfer(1.0 - std::exp(-kSigma), kColor)});
    if (!structured || !uniform) {
        return bench.recordFailure({.family = kFamily, .name = "scenes of extreme views"},
                                   structured ? uniform.error() : structured.error());
    }
    for (const ViewCase& c : allViews(*structured, bench.reduced())) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            const Exhibit exhibit = exhibitOf(*structured, c, lattice);
            recordAgainstSamples(bench, exhibit);
            recordSkippingChangesNothing(bench, exhibit);
            recordUniform(bench, exhibitOf(*uniform, c, lattice), kSigma, kColor);
        }
    }
    integralCases(bench, *structured);
    opaqueVoxelCases(bench);
    planesOnFacesCases(bench);
}

} // namespace slabcast::stability

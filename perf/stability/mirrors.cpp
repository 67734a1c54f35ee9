#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "perf/stability/symmetry.h"

namespace slabcast::stability {

namespace {

const char* const kMirrorReason =
    "a mirror in patient space and one in the view turn the sign of some numbers and change none: "
    "rounding is the same on either side of zero, the sums keep their order, and voxels stay where "
    "they are stored";

glm::dmat4 mirror(glm::dvec3 signs) {
    return glm::scale(glm::dmat4(1.0), signs);
}

/// A window to one side of the volume, so that left and right differ in it.
View asideView(const Scene& scene) {
    View view{.viewFromModel = viewFromModel({37.0, 23.0, 2.4}, scene.geometry().boundingSphere())};
    view.frustum = {-0.6, 0.45, -0.4, 0.5};
    return view;
}

/// What the mirrored volume is seen by: the picture comes out mirrored in x, or in y.
View mirrored(const View& view, glm::dvec3 inPatient, bool upsideDown) {
    const glm::dvec3 inView = upsideDown ? glm::dvec3(1, -1, 1) : glm::dvec3(-1, 1, 1);
    View result = view;
    result.viewFromModel = mirror(inView) * view.viewFromModel * mirror(inPatient);
    const Frustum& f = view.frustum;
    result.frustum = upsideDown ? Frustum{f.left, f.right, -f.top, -f.bottom}
                                : Frustum{-f.right, -f.left, f.bottom, f.top};
    return result;
}

Picture mirrored(const Picture& picture, bool upsideDown) {
    Picture result = picture;
    const auto at = [&](int x, int y) { return std::size_t(y) * picture.size.x + x; };
    for (int y = 0; y < picture.size.y; ++y) {
        for (int x = 0; x < picture.size.x; ++x) {
            result.pixels[at(x, y)] = upsideDown ? picture.pixels[at(x, picture.size.y - 1 - y)]
                                                 : picture.pixels[at(picture.size.x - 1 - x, y)];
        }
    }
    return result;
}

struct Look {
    const char* name;
    bool lit;
    LatticeKind lattice;
};
constexpr Look kLooks[] = {{"unlit, planar", false, LatticeKind::Planar},
                           {"lit, shells", true, LatticeKind::Shells}};

/// In the sagittal, coronal and axial plane, and in all three at once.
constexpr glm::dvec3 kMirrors[] = {{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}};

Result<Scene> sceneOf(Bench& bench, const Look& look, glm::dvec3 signs) {
    const glm::dmat3 turned = glm::dmat3(mirror(signs)) * obliqueAxes();
    const Volume volume =
        placedAt(formulaVolume({14, 10, 18}, VoxelType::U8, lopsided, {0.8, 1.3, 0.6}),
                 signs * glm::dvec3(12.0, -8.0, 4.0), turned);
    Appearance appearance{.tf = lopsidedTransfer()};
    if (look.lit) {
        appearance.shading = ShadingParameters{};
    }
    return bench.scene(volume, appearance, {.structure = SkipStructure::None});
}

void recordMirrors(Bench& bench, const Look& look, const Method& method, const Scene& scene,
                   std::span<const Scene> mirroredScenes) {
    const glm::ivec2 size = bench.reduced() ? glm::ivec2(16, 12) : glm::ivec2(32, 24);
    Case c{.family = kSymmetryFamily,
           .name = named({"mirrored", look.name, method.name}),
           .quantity =
               "pixels that differ in any bit from the mirrored picture, over eight mirrors",
           .reason = kMirrorReason};
    Settings settings = settingsOf(method);
    settings.lattice = look.lattice;
    settings.shaded = look.lit;
    const View view = asideView(scene);
    const Result<Drawn> plain = bench.draw(scene, settings, view, size);
    for (std::size_t i = 0; i < mirroredScenes.size(); ++i) {
        for (const bool upsideDown : {false, true}) {
            const Result<Drawn> other = bench.draw(mirroredScenes[i], settings,
                                                   mirrored(view, kMirrors[i], upsideDown), size);
            if (!plain || !other) {
                return bench.recordFailure(std::move(c), plain ? other.error() : plain.error());
            }
            c.measured += differingPixels(mirrored(plain->picture, upsideDown), other->picture);
        }
    }
    if (differingPixels(plain->picture, mirrored(plain->picture, false)) == 0) {
        c.failure = "the picture is its own mirror image: nothing could differ";
    }
    if (method.layersPerPlane == 16 && method.target == TargetFormat::Rgba8) {
        c.pictures.push_back({"seen", plain->picture});
    }
    bench.record(std::move(c));
}

} // namespace

void mirrorCases(Bench& bench) {
    for (const Look& look : kLooks) {
        std::vector<Scene> scenes;
        for (const glm::dvec3 signs :
             {glm::dvec3(1.0), kMirrors[0], kMirrors[1], kMirrors[2], kMirrors[3]}) {
            Result<Scene> scene = sceneOf(bench, look, signs);
            if (!scene) {
                return bench.recordFailure(
                    {.family = kSymmetryFamily, .name = named({"mirrored", look.name})},
                    scene.error());
            }
            scenes.push_back(std::move(*scene));
        }
        for (const Method& method : methods()) {
            recordMirrors(bench, look, method, scenes.front(), std::span(scenes).subspan(1));
        }
    }
}

} // namespace slabcast::stability

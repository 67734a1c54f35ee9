#include "perf/error/refinement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <span>

#include "core/base/parallel.h"
#include "core/reference/continuous.h"
#include "perf/error/refinement_scene.h"

namespace slabcast {

namespace {

using Picture = std::vector<glm::dvec4>;

constexpr double kFloor = 1e-8; // of float32 voxels, and well above the integral's own accuracy
constexpr int kEdge = 16;       // of the pictures that step and grid are refined in
constexpr double kSmoothFovDegrees = 4.0; // only rays through the same two faces

/// Calls color(fragCoord) for the centre of each pixel, or for where `place` lies in it.
template <class Color>
Picture pictureOf(int edge, glm::dvec2 place, const Color& color) {
    Picture picture(static_cast<std::size_t>(edge) * edge);
    parallelFor(static_cast<std::int64_t>(picture.size()), edge,
                [&](std::int64_t begin, std::int64_t end) {
                    for (std::int64_t i = begin; i < end; ++i) {
                        picture[static_cast<std::size_t>(i)] =
                            color(glm::dvec2(i % edge, i / edge) + place);
                    }
                });
    return picture;
}

constexpr glm::dvec2 kCentre(0.5);

Viewport viewportOf(int edge) {
    return {0, 0, edge, edge};
}

/// Of `total` layers that cover the cube's sphere wherever a ray's are moved to.
double stepMm(int total) {
    return 2.0 * refinedCube(1).boundingSphere().radiusMm / std::max(total - 1, 1);
}

RayFrame frameOf(int edge, double fovDegrees, int total) {
    return makeRayFrame(refinedView(fovDegrees), viewportOf(edge), refinedCube(1),
                        {.kind = LatticeKind::Planar, .total = total, .spacingMm = stepMm(total)});
}

/// Each block of four pixels looks along one ray, its layers moved by a quarter each: how a face of
/// the cube cuts a layer is then the same on average at every level.
LatticeRay rayOfBlock(const RayFrame& frame, glm::dvec2 at) {
    const glm::dvec2 block = glm::floor(at / 2.0);
    const glm::dvec2 within = glm::floor(at) - 2.0 * block;
    const double moved = (within.x + 2.0 * within.y) / 4.0;
    LatticeRay ray = rayAt(frame, 2.0 * block + 1.0);
    ray.centre -= moved * ray.step;
    ray.entry += moved;
    ray.exit += moved;
    return ray;
}

void addLevel(RefinementStudy& study, double size, const Picture& picture, const Picture& truth,
              const Picture* before) {
    RefinementLevel level{size, rmseOf(picture, truth)};
    if (before != nullptr && before->size() == picture.size()) {
        level.change = rmseOf(picture, *before);
    }
    study.levels.push_back(level);
}

/// Levels of pictures that are made of what is refined; the truth is the same at all of them.
template <class PictureAt>
void refineAgainst(RefinementStudy& study, const Picture& truth, std::initializer_list<int> levels,
                   double (*sizeAt)(int level), const PictureAt& pictureAt) {
    Picture before;
    for (const int level : levels) {
        Picture picture = pictureAt(level);
        addLevel(study, sizeAt(level), picture, truth, before.empty() ? nullptr : &before);
        before = std::move(picture);
    }
    study.convergence = convergenceOf(study.levels, study.floor);
}

Picture truthOfBlocks() {
    const FormulaInput input = refinedInput();
    const RayFrame frame = frameOf(kEdge, kRefinedFovDegrees, 1);
    return pictureOf(kEdge, kCentre, [&](glm::dvec2 at) {
        return integrateFormula(input, rayOfBlock(frame, at), kRefinedPieces);
    });
}

RefinementStudy stepStudy(const RayRule& rule, const Picture& truth) {
    RefinementStudy study{.kind = "step",
                          .method = rule.name,
                          .unit = "mm",
                          .expectedOrder = rule.order,
                          .whyExpected = rule.why,
                          .control = rule.isControl(),
                          .floor = kFloor};
    const FormulaInput input = refinedInput();
    refineAgainst(study, truth, {17, 33, 65, 129, 257}, stepMm, [&](int total) {
        const RayFrame frame = frameOf(kEdge, kRefinedFovDegrees, total);
        return pictureOf(kEdge, kCentre, [&](glm::dvec2 at) {
            return sampleFormula(input, rayOfBlock(frame, at), total, rule);
        });
    });
    return study;
}

/// How voxels are laid out: right, or one of two common mistakes.
struct GridRule {
    const char* name;
    double order;
    const char* why;
    VoxelPlace place;
};

const GridRule kGridRules[] = {
    {"trilinear", 2.0,
     "trilinear interpolation between voxel centres is of order 2 in the grid's spacing",
     voxelCentre},
    {"half a voxel off", 1.0, "values of the voxels' corners at their centres: order 1",
     [](int voxel, int edge) { return static_cast<double>(voxel) / edge; }},
    {"stretched", 1.0,
     "the outer voxels' centres on the box's faces, a share of 1/N too large: order 1",
     [](int voxel, int edge) { return static_cast<double>(voxel) / (edge - 1); }}};

RefinementStudy gridStudy(const GridRule& rule, const Picture& truth) {
    RefinementStudy study{.kind = "grid",
                          .method = rule.name,
                          .unit = "mm",
                          .expectedOrder = rule.order,
                          .whyExpected = rule.why,
                          .control = rule.order != 2.0,
                          .floor = kFloor};
    const FormulaInput input = refinedInput();
    const auto voxelMm = [](int edge) { return kCubeMm / edge; };
    refineAgainst(study, truth, {12, 24, 48, 96}, voxelMm, [&](int edge) {
        const Volume volume = refinedVolume(input.field, edge, rule.place);
        const Texels texels =
            encodeTexels(volume, computeStatistics(volume), TexelFormat::R32fExact);
        return renderContinuous({.texels = &texels,
                                 .geometry = volume.geometry,
                                 .tf = input.tf,
                                 .view = refinedView(kRefinedFovDegrees),
                                 .viewport = viewportOf(kEdge)});
    });
    return study;
}

// ---- pixels

/// The mean of each block of 2 x 2 pixels of rows of `edge`.
Picture halved(const Picture& picture, int edge) {
    Picture half(picture.size() / 4);
    const auto width = static_cast<std::size_t>(edge);
    for (std::size_t i = 0; i < picture.size(); ++i) {
        half[i / width / 2 * (width / 2) + i % width / 2] += 0.25 * picture[i];
    }
    return half;
}

/// The mean over each of edge^2 pixels from tensor products of nodes and weights in [0, 1].
template <class Color>
Picture averaged(int edge, std::span<const glm::dvec2> rule, const Color& color) {
    return pictureOf(edge, glm::dvec2(0.0), [&](glm::dvec2 corner) {
        glm::dvec4 sum(0.0);
        for (const glm::dvec2& y : rule) {
            for (const glm::dvec2& x : rule) {
                sum += x.y * y.y * color(corner + glm::dvec2(x.x, y.x));
            }
        }
        return sum;
    });
}

using RayColor = std::function<glm::dvec4(const LatticeRay& ray)>;

/// What pixels are points of.
struct PixelScene {
    const char* name;
    double order;
    const char* why;
    double fovDegrees;
    std::vector<int> edges;       // coarse to fine
    std::vector<glm::dvec2> rule; // (node, weight) of the truth's mean over a finest pixel
    std::vector<RayColor> colors; // several pictures, one above the other
};

/// Gauss-Legendre of three points: degree 5.
std::vector<glm::dvec2> gaussRule() {
    const double node = 0.5 * std::sqrt(0.6);
    return {{0.5 - node, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.5 + node, 5.0 / 18.0}};
}

std::vector<glm::dvec2> midpointRule(int points) {
    std::vector<glm::dvec2> rule;
    for (int k = 0; k < points; ++k) {
        rule.emplace_back((k + 0.5) / points, 1.0 / points);
    }
    return rule;
}

/// A ball of one density, by its chord.
RayColor ballOf(double extinctionPerMm, glm::dvec3 centreUvw) {
    return [extinctionPerMm, centreUvw](const LatticeRay& ray) {
        constexpr double kRadiusMm = 0.35 * kCubeMm;
        const glm::dvec3 from = (ray.centre - centreUvw) * kCubeMm;
        const glm::dvec3 direction = glm::normalize(ray.step);
        const glm::dvec3 nearest = from - glm::dot(from, direction) * direction;
        const double halfSquared = kRadiusMm * kRadiusMm - glm::dot(nearest, nearest);
        const double chordMm = halfSquared > 0.0 ? 2.0 * std::sqrt(halfSquared) : 0.0;
        return glm::dvec4(-std::expm1(-extinctionPerMm * chordMm));
    };
}

/// In places of no symmetry: where an edge runs along with the pixels, all of them err alike.
std::vector<RayColor> ballsOf(double extinctionPerMm) {
    std::vector<RayColor> balls;
    for (const glm::dvec3& centre :
         {glm::dvec3(0.513, 0.529, 0.487), glm::dvec3(0.471, 0.508, 0.523),
          glm::dvec3(0.537, 0.463, 0.491), glm::dvec3(0.492, 0.541, 0.459)}) {
        balls.push_back(ballOf(extinctionPerMm, centre));
    }
    return balls;
}

std::vector<PixelScene> pixelScenes() {
    const std::vector<int> edges{8, 16, 32, 64, 128};
    const auto smooth = [input = refinedInput()](const LatticeRay& ray) {
        return integrateFormula(input, ray, kRefinedPieces);
    };
    return {{"smooth region",
             2.0,
             "a pixel's centre is the midpoint rule for its mean: order 2",
             kSmoothFovDegrees,
             {2, 4, 8, 16, 32},
             gaussRule(),
             {smooth}},
            {"silhouette of a translucent ball", 1.0,
             "colour rises as the root of the distance from the edge: off by O(s^1/2) in a share "
             "O(s) of the pixels, RMSE of order 1",
             24.0, edges, midpointRule(6), ballsOf(1.0 / kCubeMm)},
            {"silhouette of an opaque ball", 0.5,
             "colour jumps: off by O(1) in a share O(s) of the pixels, RMSE of order 1/2", 24.0,
             edges, midpointRule(6), ballsOf(1e6)}};
}

/// `place`: of the ray in its pixel.
RefinementStudy pixelStudy(const PixelScene& scene, glm::dvec2 place) {
    const bool control = place != kCentre;
    RefinementStudy study{.kind = "pixel",
                          .method = std::string(scene.name) + (control ? ", rays at corners" : ""),
                          .unit = "of the picture",
                          .rightOrder = scene.order,
                          .expectedOrder = control ? 1.0 : scene.order,
                          .whyExpected =
                              control ? "a pixel's corner is half a pixel off: order 1" : scene.why,
                          .control = control,
                          .floor = kFloor};
    const auto pictureAt = [&](int edge, const auto& pixel) {
        const RayFrame frame = frameOf(edge, scene.fovDegrees, 1);
        Picture all;
        for (const RayColor& color : scene.colors) {
            const auto colorAt = [&](glm::dvec2 at) { return color(rayAt(frame, at)); };
            const Picture one = pixel(edge, colorAt);
            all.insert(all.end(), one.begin(), one.end());
        }
        return all;
    };
    const auto mean = [&](int edge, const auto& colorAt) {
        return averaged(edge, scene.rule, colorAt);
    };
    const auto point = [&](int edge, const auto& colorAt) {
        return pictureOf(edge, place, colorAt);
    };
    Picture truth = pictureAt(scene.edges.back(), mean);
    for (int edge = scene.edges.back(); edge >= scene.edges.front(); edge /= 2) {
        addLevel(study, 1.0 / edge, pictureAt(edge, point), truth, nullptr);
        truth = halved(truth, edge);
    }
    std::reverse(study.levels.begin(), study.levels.end());
    study.convergence = convergenceOf(study.levels, study.floor);
    return study;
}

} // namespace

std::vector<RefinementStudy> refine() {
    std::vector<RefinementStudy> studies;
    const Picture ofBlocks = truthOfBlocks();
    for (const RayRule& rule : rayRules()) {
        studies.push_back(stepStudy(rule, ofBlocks));
    }
    const Picture truth = refinedTruth(refinedInput(), kEdge);
    for (const GridRule& rule : kGridRules) {
        studies.push_back(gridStudy(rule, truth));
    }
    const std::vector<PixelScene> scenes = pixelScenes();
    for (const PixelScene& scene : scenes) {
        studies.push_back(pixelStudy(scene, kCentre));
    }
    studies.push_back(pixelStudy(scenes.front(), glm::dvec2(0.0)));
    return studies;
}

} // namespace slabcast

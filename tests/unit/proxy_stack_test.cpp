#include "core/draw/proxy_stack.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "core/plan/shader_variant.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using test::FrameScene;

constexpr int kPlaneCounts[] = {1, 2, 7, 444};

/// Whether a point of tangent space lies in the regular 10-gon around the outline's ellipse, first
/// vertex at +x.
bool inDecagon(const Outline& outline, glm::dvec2 tangent) {
    const glm::dvec2 q = (tangent - outline.centre) / outline.halfSize;
    for (int side = 0; side < 10; ++side) {
        const double normal = (2 * side + 1) * M_PI / 10.0;
        if (q.x * std::cos(normal) + q.y * std::sin(normal) > 1.0) {
            return false;
        }
    }
    return true;
}

bool inRectangle(const Outline& outline, glm::dvec2 tangent) {
    return glm::all(glm::lessThanEqual(glm::abs(tangent - outline.centre), outline.halfSize));
}

/// What is sure to be drawn of a plane: nothing where the stack leaves it out, and less by the
/// 1/256 pixel to which a rasteriser may snap its corners.
Outline drawnPart(const std::vector<Outline>& outlines, int index, const FrameScene& scene) {
    if (index < 0 || index >= static_cast<int>(outlines.size()) || outlines[index].empty()) {
        return {};
    }
    return {outlines[index].centre, outlines[index].halfSize - scene.tangentPerPixel() / 256.0};
}

Outline drawnPart(const ProxyStack& stack, int plane, const FrameScene& scene) {
    return drawnPart(stack.outlines, plane - stack.firstPlane, scene);
}

/// A scene dealt out to so many planes, the last of them possibly short or without any layer.
struct Dealt {
    FrameScene scene;
    int planes = 1;
    int layersPerPlane = 1;
};

Dealt randomDeal(Dice& dice, int planes) {
    const int total = dice.chance(0.2) ? 1 + dice.below(planes) : planes + dice.below(3 * planes);
    return {test::randomScene(dice, total), planes, (total + planes - 1) / planes};
}

struct Tally {
    int covered = 0;
    int bare = 0;
};

/// Rays through the box, and of each the layers that it meets: `visit(layer, ray, tangent)`.
template <class Visit>
void forLayersMet(Dice& dice, const FrameScene& scene, int rays, Visit visit) {
    const RayFrame frame = scene.frame();
    for (int k = 0; k < rays; ++k) {
        const glm::dvec2 at = test::randomFragCoord(dice, scene);
        const LatticeRay ray = rayAt(frame, at);
        const LayerRange met = layersOf(ray, scene.lattice.total);
        for (int layer = met.begin; layer < met.end; ++layer) {
            visit(layer, ray, scene.tangentAt(at));
        }
    }
}

TEST(SphereStack, EveryRayMeetsItsLayersOnTheirPlanes) {
    for (const int planes : kPlaneCounts) {
        Dice dice(planes);
        Tally tally;
        for (int view = 0; view < 2000; ++view) {
            const Dealt d = randomDeal(dice, planes);
            const ProxyStack stack =
                sphereStack(d.scene.frame(), d.scene.view.frustum, planes, d.layersPerPlane);
            forLayersMet(dice, d.scene, 10, [&](int layer, const LatticeRay&, glm::dvec2 tangent) {
                const Outline outline = drawnPart(stack, layer / d.layersPerPlane, d.scene);
                const bool covered = !outline.empty() && inDecagon(outline, tangent);
                ++(covered ? tally.covered : tally.bare);
                EXPECT_TRUE(covered)
                    << "planes " << planes << ", view " << view << ", layer " << layer;
            });
            if (tally.bare > 0) {
                return;
            }
        }
        EXPECT_GT(tally.covered, 10000) << "planes " << planes;
    }
}

/// A cube of 10 mm, 30 mm before the eye, seen through a window that is wide enough.
FrameScene cubeAhead(LatticeKind kind, int total) {
    FrameScene scene;
    scene.geometry = {.dims = glm::ivec3(10), .originMm = glm::dvec3(-4.5)};
    scene.view.viewFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, -30.0});
    scene.viewport = {0, 0, 1 << 20, 1 << 20}; // pixels so small that what they add is lost below
    scene.lattice = {kind, total, 2.0 * scene.geometry.boundingSphere().radiusMm / total};
    return scene;
}

TEST(SphereStack, AThinSlabIsTheSpheresDisc) {
    const int total = 1000;
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        const FrameScene scene = cubeAhead(kind, total);
        const double radius = scene.geometry.boundingSphere().radiusMm;
        const ProxyStack stack = sphereStack(scene.frame(), scene.view.frustum, total, 1);
        ASSERT_EQ(stack.firstPlane, 0);
        ASSERT_EQ(static_cast<int>(stack.outlines.size()), total);
        for (int plane = 0; plane < total; ++plane) {
            const double offset = (plane + 0.5 - total / 2.0) * scene.lattice.spacingMm;
            // Planar: the disc at that depth. Shells: where the shell of that distance d meets the
            // sphere, at the depth (d^2 + 30^2 - r^2) / (2 * 30).
            const double d = 30.0 + offset;
            const double depth =
                kind == LatticeKind::Planar ? d : (d * d + 900.0 - radius * radius) / 60.0;
            const double across = kind == LatticeKind::Planar
                                      ? std::sqrt(radius * radius - offset * offset)
                                      : std::sqrt(std::max(0.0, d * d - depth * depth));
            const Outline& outline = stack.outlines[plane];
            EXPECT_NEAR(outline.centre.x, 0.0, 1e-12);
            EXPECT_EQ(outline.halfSize.x, outline.halfSize.y);
            EXPECT_GE(outline.halfSize.x, across / depth);
            // The disc shrinks fastest at the sphere's ends: by sqrt(2 r h) over the outermost
            // layer.
            EXPECT_LE(outline.halfSize.x,
                      across / depth + std::sqrt(2.0 * radius * scene.lattice.spacingMm) / 20.0);
            if (std::abs(offset) < radius / 2.0) {
                EXPECT_LE(outline.halfSize.x, across / depth * 1.005) << plane;
            }
        }
    }
}

TEST(SphereStack, LeavesOutWhatTheViewCannotShow) {
    for (const LatticeKind kind : {LatticeKind::Planar, LatticeKind::Shells}) {
        FrameScene scene = cubeAhead(kind, 100);
        const auto stack = [&] { return sphereStack(scene.frame(), scene.view.frustum, 100, 1); };
        EXPECT_EQ(stack().outlines.size(), 100U);
        scene.view.nearDepth = 30.0; // the nearer half
        EXPECT_EQ(stack().firstPlane, 50);
        EXPECT_EQ(stack().outlines.size(), 50U);
        scene.view.nearDepth = 39.0;
        EXPECT_TRUE(stack().outlines.empty());
        scene.view.nearDepth = 0.0;
        scene.view.frustum = {2.0, 3.0, -1.0, 1.0}; // beside it
        EXPECT_TRUE(stack().outlines.empty());
    }
    FrameScene behind = cubeAhead(LatticeKind::Planar, 100);
    behind.view.viewFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 30.0});
    EXPECT_TRUE(sphereStack(behind.frame(), behind.view.frustum, 100, 1).outlines.empty());
}

TEST(SphereStack, PlanesBeyondTheLastLayerAreNotDrawn) {
    const FrameScene scene = cubeAhead(LatticeKind::Planar, 450);
    const ProxyStack stack = sphereStack(scene.frame(), scene.view.frustum, 444, 2); // 225 hold all
    EXPECT_EQ(stack.firstPlane, 0);
    EXPECT_EQ(stack.outlines.size(), 225U);
}

TEST(SphereStack, GroupsOfPlanesAreDrawnAsSquares) {
    Dice dice(7);
    constexpr int kPlanes = 2 * kMaxOutlines + 5;
    Tally tally;
    for (int view = 0; view < 100; ++view) {
        const Dealt d = randomDeal(dice, kPlanes);
        const ProxyStack stack =
            sphereStack(d.scene.frame(), d.scene.view.frustum, kPlanes, d.layersPerPlane);
        const int drawn = static_cast<int>(stack.outlines.size());
        const int perOutline = std::max(1, (drawn + kMaxOutlines - 1) / kMaxOutlines);
        std::vector<Outline> groups;
        for (int first = 0; first < drawn; first += perOutline) {
            groups.push_back(joined(group(stack, groups.size(), perOutline)));
        }
        forLayersMet(dice, d.scene, 3, [&](int layer, const LatticeRay&, glm::dvec2 tangent) {
            const int index = layer / d.layersPerPlane - stack.firstPlane;
            const bool inStack = index >= 0 && index < drawn;
            const Outline outline = drawnPart(groups, inStack ? index / perOutline : -1, d.scene);
            const bool covered =
                perOutline > 1 ? inRectangle(outline, tangent) : inDecagon(outline, tangent);
            ++(covered && !outline.empty() ? tally.covered : tally.bare);
        });
    }
    EXPECT_EQ(tally.bare, 0);
    EXPECT_GT(tally.covered, 10000);
}

/// A cloud with some blocks occupied: all that the stack reads of one.
FreeLengths randomCloud(Dice& dice, glm::ivec3 dims) {
    FreeLengths cloud;
    cloud.blockEdgeVoxels = 1 << dice.below(4);
    cloud.blocks = (dims + cloud.blockEdgeVoxels - 1) / cloud.blockEdgeVoxels;
    cloud.counts.resize(static_cast<std::size_t>(cloud.blocks.x) * cloud.blocks.y * cloud.blocks.z);
    const double share = std::array{0.0, 0.02, 0.3, 1.0}[dice.below(4)];
    for (std::uint8_t& length : cloud.counts) {
        length = dice.chance(share) ? 0 : 1;
        cloud.occupiedBlocks += length == 0;
    }
    return cloud;
}

/// Whether the place that the texture unit reads, clamped to the edge, lies in an occupied block.
bool isOccupied(const FreeLengths& cloud, glm::ivec3 dims, glm::dvec3 uvw) {
    const glm::dvec3 voxel = glm::clamp(uvw, 0.0, 1.0) * glm::dvec3(dims);
    const glm::ivec3 block =
        glm::min(glm::ivec3(voxel / double(cloud.blockEdgeVoxels)), cloud.blocks - 1);
    return cloud.counts[(std::size_t(block.z) * cloud.blocks.y + block.y) * cloud.blocks.x +
                        block.x] == 0;
}

/// Length of the view's most oblique layer.
double longestLayerMm(const FrameScene& scene) {
    const Frustum& f = scene.view.frustum;
    const glm::dvec2 widest(std::max(std::abs(f.left), std::abs(f.right)),
                            std::max(std::abs(f.bottom), std::abs(f.top)));
    return scene.lattice.spacingMm * std::sqrt(1.0 + glm::dot(widest, widest));
}

TEST(TightStack, EveryOccupiedSampleLiesOnItsPlane) {
    for (const int planes : kPlaneCounts) {
        Dice dice(100 + planes);
        Tally tally;
        for (int view = 0; view < 2000; ++view) {
            const Dealt d = randomDeal(dice, planes);
            const VolumeGeometry& geometry = d.scene.geometry;
            const FreeLengths cloud = randomCloud(dice, geometry.dims);
            const std::vector<VisibleBox> boxes =
                visibleBoxes(cloud, geometry, longestLayerMm(d.scene));
            const ProxyStack stack =
                tightStack(d.scene.frame(), d.scene.view.frustum,
                           d.scene.view.viewFromModel * geometry.modelFromUvw(), boxes, planes,
                           d.layersPerPlane);
            const int total = d.scene.lattice.total;
            forLayersMet(
                dice, d.scene, 10, [&](int layer, const LatticeRay& ray, glm::dvec2 tangent) {
                    if (isOccupied(cloud, geometry.dims, samplePosition(ray, total, layer))) {
                        const Outline outline = drawnPart(stack, layer / d.layersPerPlane, d.scene);
                        const bool covered = !outline.empty() && inRectangle(outline, tangent);
                        ++(covered ? tally.covered : tally.bare);
                        EXPECT_TRUE(covered)
                            << "planes " << planes << ", view " << view << ", layer " << layer;
                    }
                });
            if (tally.bare > 0) {
                return;
            }
        }
        EXPECT_GT(tally.covered, 5000) << "planes " << planes;
    }
}

TEST(TightStack, OneBlockIsItsRectangleOnItsPlanes) {
    const FrameScene scene = cubeAhead(LatticeKind::Planar, 100);
    // A block before the middle: x and y within 1 mm of the axis, 27 to 29 mm from the eye.
    const VisibleBox box{{0.4, 0.4, 0.6}, {0.6, 0.6, 0.8}};
    const ProxyStack stack = tightStack(scene.frame(), scene.view.frustum,
                                        scene.view.viewFromModel * scene.geometry.modelFromUvw(),
                                        std::span(&box, 1), 100, 1);
    const double origin = 30.0 - 50.0 * scene.lattice.spacingMm;
    EXPECT_EQ(stack.firstPlane, static_cast<int>((27.0 - origin) / scene.lattice.spacingMm));
    EXPECT_EQ(stack.firstPlane + static_cast<int>(stack.outlines.size()) - 1,
              static_cast<int>((29.0 - origin) / scene.lattice.spacingMm));
    for (const Outline& outline : stack.outlines) {
        EXPECT_NEAR(outline.centre.x, 0.0, 1e-12);
        EXPECT_NEAR(outline.centre.y, 0.0, 1e-12);
        EXPECT_NEAR(outline.halfSize.x, 1.0 / 27.0, 2e-4 / 27.0);
        EXPECT_GE(outline.halfSize.y, 1.0 / 27.0);
    }
}

TEST(TightStack, NothingVisibleIsNothingToDraw) {
    const FrameScene scene = cubeAhead(LatticeKind::Shells, 100);
    const glm::dmat4 viewFromUvw = scene.view.viewFromModel * scene.geometry.modelFromUvw();
    EXPECT_TRUE(
        tightStack(scene.frame(), scene.view.frustum, viewFromUvw, {}, 100, 1).outlines.empty());
    const VisibleBox all;
    FrameScene near = scene;
    near.view.nearDepth = 36.0;
    EXPECT_TRUE(tightStack(near.frame(), near.view.frustum, viewFromUvw, std::span(&all, 1), 100, 1)
                    .outlines.empty());
}

TEST(VisibleBoxes, HoldEveryOccupiedBlock) {
    Dice dice(11);
    for (int k = 0; k < 200; ++k) {
        const VolumeGeometry geometry = test::randomGeometry(dice);
        const FreeLengths cloud = randomCloud(dice, geometry.dims);
        const std::vector<VisibleBox> boxes = visibleBoxes(cloud, geometry, 1e-3);
        const auto inBoxes = [&](glm::dvec3 uvw) {
            return std::any_of(boxes.begin(), boxes.end(), [&](const VisibleBox& box) {
                return glm::all(glm::greaterThanEqual(uvw, box.low)) &&
                       glm::all(glm::lessThanEqual(uvw, box.high));
            });
        };
        EXPECT_EQ(boxes.empty(), cloud.occupiedBlocks == 0);
        for (int point = 0; point < 50; ++point) {
            const glm::dvec3 uvw = dice.inCube(0.0, 1.0);
            if (isOccupied(cloud, geometry.dims, uvw)) {
                EXPECT_TRUE(inBoxes(uvw));
            }
        }
    }
}

TEST(VisibleBoxes, ReachHalfALayerBeyondTheVolumesFacesAlone) {
    FreeLengths cloud;
    cloud.blockEdgeVoxels = 8;
    cloud.blocks = {3, 1, 1};
    cloud.counts = {1, 0, 0};
    const VolumeGeometry geometry{.dims = {20, 8, 8}, .spacingMm = {1.0, 2.0, 1.0}};
    const std::vector<VisibleBox> boxes = visibleBoxes(cloud, geometry, 4.0);
    ASSERT_EQ(boxes.size(), 2U);
    EXPECT_EQ(boxes[0].low.x, 0.4);  // 8 of 20 voxels: the next block is free, not a face
    EXPECT_EQ(boxes[0].high.x, 0.8); // 16 of 20
    EXPECT_EQ(boxes[1].low.x, 0.8);
    const double guard = 1.1e-3; // of a voxel
    EXPECT_NEAR(boxes[1].high.x, 1.0 + 2.0 / 20.0, guard / 20.0);
    EXPECT_NEAR(boxes[0].low.y, -2.0 / 16.0, guard / 8.0);
    EXPECT_NEAR(boxes[0].high.y, 1.0 + 2.0 / 16.0, guard / 8.0);
    EXPECT_LE(boxes[0].low.z, -2.0 / 8.0);
}

} // namespace
} // namespace slabcast

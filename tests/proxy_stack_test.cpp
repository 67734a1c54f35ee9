#include "core/frame/proxy_stack.h"

#include <array>
#include <numeric>

#include <gtest/gtest.h>

#include "core/frame/shader_variant.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;
using test::FrameScene;

constexpr int kPlaneCounts[] = {1, 2, 7, 444};

/// Whether a point of tangent space lies in the regular 10-gon around the outline's ellipse, first vertex at +x.
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

/// The outline of a plane; an empty one where the stack leaves the plane out.
Outline outlineOf(const ProxyStack& stack, int plane) {
    const int index = plane - stack.firstPlane;
    const bool drawn = index >= 0 && index < static_cast<int>(stack.outlines.size());
    return drawn ? stack.outlines[index] : Outline{};
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
            const ProxyStack stack = sphereStack(d.scene.frame(), d.scene.view.frustum, planes, d.layersPerPlane);
            forLayersMet(dice, d.scene, 10, [&](int layer, const LatticeRay&, glm::dvec2 tangent) {
                const Outline outline = outlineOf(stack, layer / d.layersPerPlane);
                const bool covered = !outline.empty() && inDecagon(outline, tangent);
                ++(covered ? tally.covered : tally.bare);
                EXPECT_TRUE(covered) << "planes " << planes << ", view " << view << ", layer " << layer;
            });
            if (tally.bare > 0) {
                return;
            }
        }
        EXPECT_GT(tally.covered, 10000) << "planes " << planes;
    }
}

/// A cloud with some blocks occupied: all that the stack reads of one.
ProximityCloud randomCloud(Dice& dice, glm::ivec3 dims) {
    ProximityCloud cloud;
    cloud.blockEdgeVoxels = 1 << dice.below(4);
    cloud.blocks = (dims + cloud.blockEdgeVoxels - 1) / cloud.blockEdgeVoxels;
    cloud.freeLengths.resize(static_cast<std::size_t>(cloud.blocks.x) * cloud.blocks.y * cloud.blocks.z);
    const double share = std::array{0.0, 0.02, 0.3, 1.0}[dice.below(4)];
    for (std::uint8_t& length : cloud.freeLengths) {
        length = dice.chance(share) ? 0 : 1;
        cloud.occupiedBlocks += length == 0;
    }
    return cloud;
}

/// Whether the place that the texture unit reads, clamped to the edge, lies in an occupied block.
bool isOccupied(const ProximityCloud& cloud, glm::ivec3 dims, glm::dvec3 uvw) {
    const glm::dvec3 voxel = glm::clamp(uvw, 0.0, 1.0) * glm::dvec3(dims);
    const glm::ivec3 block = glm::min(glm::ivec3(voxel / double(cloud.blockEdgeVoxels)), cloud.blocks - 1);
    return cloud.freeLengths[(std::size_t(block.z) * cloud.blocks.y + block.y) * cloud.blocks.x + block.x] == 0;
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
            const ProximityCloud cloud = randomCloud(dice, geometry.dims);
            const std::vector<VisibleBox> boxes = visibleBoxes(cloud, geometry, longestLayerMm(d.scene));
            const ProxyStack stack =
                tightStack(d.scene.frame(), d.scene.view.frustum,
                           d.scene.view.viewFromModel * geometry.modelFromUvw(), boxes, planes, d.layersPerPlane);
            const int total = d.scene.lattice.total;
            forLayersMet(dice, d.scene, 10, [&](int layer, const LatticeRay& ray, glm::dvec2 tangent) {
                if (isOccupied(cloud, geometry.dims, samplePosition(ray, total, layer))) {
                    const Outline outline = outlineOf(stack, layer / d.layersPerPlane);
                    const bool covered = !outline.empty() && inRectangle(outline, tangent);
                    ++(covered ? tally.covered : tally.bare);
                    EXPECT_TRUE(covered) << "planes " << planes << ", view " << view << ", layer " << layer;
                }
            });
            if (tally.bare > 0) {
                return;
            }
        }
        EXPECT_GT(tally.covered, 5000) << "planes " << planes;
    }
}

} // namespace
} // namespace slabcast

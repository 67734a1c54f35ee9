#include "core/draw/frame_block.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include "core/scene/scene.h"
#include "core/transfer/table_axis.h"

namespace slabcast {

namespace {

/// A floor that is far below what the least step of a texel makes, for data without any gradient.
constexpr double kLeastFloor = 1e-9;

constexpr int kToInitialLevel = 31; // levels: more than any octree has

glm::vec4 packed(glm::dvec3 xyz, double w) {
    return glm::vec4(glm::dvec4(xyz, w));
}

/// Sampled value of an exact texel from what texelFetch returns in r and g.
glm::vec4 decodeWeights(TexelFormat format) {
    return format == TexelFormat::Rg8Exact ? glm::vec4(255.0F * 256.0F, 255.0F, 0.0F, 0.0F)
                                           : glm::vec4(1.0F, 0.0F, 0.0F, 0.0F);
}

/// As the texture's components hold a node: 64 bits lie in four components of 16.
glm::uvec4 shaderTest(const NodeTest& test, int bitsPerNode) {
    const glm::uvec4& w = test.words;
    return bitsPerNode == 64 ? glm::uvec4(w.x & 0xffffU, w.x >> 16, w.y & 0xffffU, w.y >> 16) : w;
}

/// Exact lower bounds become float32 comparisons: a guard well above their rounding, far below a
/// voxel. So does a place at the volume's far face, which is none of a block beyond.
constexpr double kBelow = 1.0 - 1e-5;
constexpr double kInside = 1.0 - 1e-6;

void fillSkip(FrameBlock& block, const BuiltSkip& skip, glm::ivec3 dims, double spacingMm) {
    const int edge = skip.options.blockEdgeVoxels;
    const glm::ivec3 blocks = blocksOf(dims, edge);
    block.skipMap = packed(glm::dvec3(dims) / double(edge) * kInside,
                           skip.lengths && skip.lengths->quantumMm > 0.0
                               ? spacingMm / (skip.lengths->quantumMm * kBelow)
                               : 0.0);
    const bool topDown = skip.options.traversal == Traversal::TopDown;
    block.skipBlocks = glm::ivec4(blocks - 1, topDown ? kToInitialLevel : 1);
    if (skip.octree) {
        const int bits = skip.octree->bitsPerNode;
        const SkipLayout& layout = *skip.layout;
        block.octree = {skip.octree->coarsest(), std::countr_zero(unsigned(layout.perTexel)),
                        layout.levels.front().fold, bits};
        std::transform(layout.levels.begin(), layout.levels.end(), block.octreeLevels.begin(),
                       [](const SkipLevel& level) { return glm::ivec4(level.first, 0, 0, 0); });
        block.nodeTest = shaderTest(skip.test, bits);
    }
}

void fillShading(FrameBlock& block, const ShadingParameters& shading,
                 const VolumeGeometry& geometry, double valueScale, double steepestPerMm) {
    // A difference over one voxel is dims times its derivative by uvw; gradients are covectors:
    // inverse transpose.
    const glm::dmat3 uvwFromModel(geometry.uvwFromModel());
    const glm::dmat3 patientRows = glm::transpose(glm::dmat3(geometry.modelFromUvw()));
    const double ofOneTexelStep = valueScale / geometry.smallestVoxelEdgeMm();
    const double floor = std::max(shading.gradientFloorPerMm, kLeastFloor * ofOneTexelStep);
    for (int row = 0; row < 3; ++row) {
        const glm::dvec3 covector = uvwFromModel[row] * glm::dvec3(geometry.dims) * valueScale;
        block.gradientRow[row] = packed(covector / floor, row == 0 ? steepestPerMm / floor : 0.0);
        block.patientRow[row] = packed(patientRows[row], 0.0);
    }
    block.material = glm::vec4(
        glm::dvec4(shading.ambient, shading.diffuse, shading.specular, shading.shininess));
}

/// distance^2 - (depth * length)^2 over the spacing, where the length is of a ray per unit of
/// depth: |centre|^2 - |tangent(p) depth|^2 across the view's axis, as (centre - place) . (centre +
/// place).
void fillShells(FrameBlock& block, const RayFrame& f) {
    const double depth = f.sphereCentre.z;
    const glm::dvec2 centre(f.sphereCentre);
    const glm::dvec2 place0 = f.tangent0 * depth;
    const glm::dvec2 perPixel = f.tangentPerPixel * depth;
    const double at0 = glm::dot(centre - place0, centre + place0);
    block.sphere = glm::vec4(glm::dvec4(at0 / f.spacing, 0.0, depth, f.sphereDistance));
    block.missed =
        glm::vec4(glm::dvec4(-2.0 * place0 * perPixel, -perPixel * perPixel) / f.spacing);
}

/// What makes a texel's alpha a number of halvings (or of reference lengths), for one spacing.
double lengthScale(const RayFrame& f, const Scene& scene) {
    const double spacingMm = f.spacing * f.mmPerViewUnit;
    const ClassifiedTexels* classified = scene.classified();
    return classified != nullptr ? spacingMm / classified->referenceLengthMm
                                 : spacingMm * scene.table().extinctionPerMm * std::numbers::log2e;
}

/// `width`: texels of the table's texture.
glm::vec4 tableMap(const Scene& scene, TableRead read, int width) {
    const TableAxis axis = tableAxis(scene.texels(), scene.table());
    if (read == TableRead::Exact) {
        return packed({axis.texelsPerSampled, axis.firstSampled, 0.0}, axis.lastTexel);
    }
    // A texel's middle lies half a texel from its edge.
    const double atZero = 0.5 - axis.firstSampled * axis.texelsPerSampled;
    return packed(glm::dvec3(axis.texelsPerSampled, atZero, 0.0) / double(width), axis.lastTexel);
}

} // namespace

FrameBlock makeFrameBlock(const RayFrame& f, const Scene& scene, const FramePlan& plan,
                          int tableWidth) {
    FrameBlock block{};
    block.centre0 = packed(f.centre0, f.lattice.total / 2.0);
    block.centreX = packed(f.centreX, (f.nearDepth - f.sphereCentre.z) / f.spacing);
    block.centreY = packed(f.centreY, f.nearDepth / f.spacing);
    block.step0 = packed(f.direction0 * f.spacing, lengthScale(f, scene));
    block.stepX = packed(f.directionX * f.spacing, f.sphereDistance / f.spacing);
    block.stepY = packed(f.directionY * f.spacing, 1.0 / f.spacing);
    block.tangent = glm::vec4(glm::dvec4(f.tangent0, f.tangentPerPixel));
    fillShells(block, f);
    block.viewport = glm::vec4(
        glm::dvec4(f.viewportCentre, plan.layersPerPlane,
                   plan.variant.fetchesTarget ? saturatedAlpha(plan) : plan.terminationAlpha));
    block.tableMap = tableMap(scene, plan.variant.table, tableWidth);
    if (const PreintegratedTable* table = scene.preintegrated()) {
        const int last = table->size() - 1;
        block.tableEnds = {table->at(0, 0), table->at(last, last)};
    }
    block.decode = decodeWeights(scene.texels().format);
    if (scene.skip().exists()) {
        fillSkip(block, scene.skip(), scene.geometry().dims, f.spacing * f.mmPerViewUnit);
    }
    if (plan.variant.shaded) {
        const NormalTexels* normals = scene.normals();
        fillShading(block, scene.look().shading, scene.geometry(), scene.texels().valueScale,
                    normals != nullptr ? normals->steepestPerMm : 0.0);
    }
    block.counts.y = plan.layersPerPlane;
    block.jitter = {glm::ivec2(f.viewportCorner), 0, 0};
    return block;
}

} // namespace slabcast

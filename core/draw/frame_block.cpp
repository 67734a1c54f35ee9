#include "core/draw/frame_block.h"

#include <algorithm>
#include <bit>

#include "core/scene/scene.h"
#include "core/transfer/table_axis.h"

namespace slabcast {

namespace {

/// smoothstep() needs two different edges, also for data without any gradient.
constexpr double kLeastGradient = 1e-30;

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

void fillSkip(FrameBlock& block, const BuiltSkip& skip, glm::ivec3 dims) {
    const int edge = skip.options.blockEdgeVoxels;
    const glm::ivec3 blocks = blocksOf(dims, edge);
    block.skipMap =
        packed(glm::dvec3(dims) / double(edge), skip.lengths ? skip.lengths->quantumMm : 0.0);
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
                 const VolumeGeometry& geometry, double valueScale) {
    // A difference over one voxel is dims times its derivative by uvw; gradients are covectors:
    // inverse transpose.
    const glm::dmat3 uvwFromModel(geometry.uvwFromModel());
    const glm::dmat3 patientRows = glm::transpose(glm::dmat3(geometry.modelFromUvw()));
    for (int row = 0; row < 3; ++row) {
        const glm::dvec3 covector = uvwFromModel[row] * glm::dvec3(geometry.dims) * valueScale;
        block.gradientRow[row] =
            packed(covector, row == 0 ? std::max(shading.gradientFloorPerMm, kLeastGradient) : 0.0);
        block.patientRow[row] = packed(patientRows[row], 0.0);
    }
    block.material = glm::vec4(
        glm::dvec4(shading.ambient, shading.diffuse, shading.specular, shading.shininess));
}

} // namespace

FrameBlock makeFrameBlock(const RayFrame& f, const Scene& scene, const FramePlan& plan) {
    FrameBlock block{};
    block.centre0 = packed(f.centre0, f.lattice.total / 2.0);
    block.centreX = packed(f.centreX, (f.nearDepth - f.sphereCentre.z) / f.spacing);
    block.centreY = packed(f.centreY, f.nearDepth);
    block.direction0 = packed(f.direction0, f.spacing);
    block.directionX = packed(f.directionX, 1.0 / f.spacing);
    block.directionY = packed(f.directionY, f.mmPerViewUnit);
    block.tangent = glm::vec4(glm::dvec4(f.tangent0, f.tangentPerPixel));
    block.sphere = packed(f.sphereCentre, f.sphereDistance);
    block.miss = glm::vec4(glm::dvec4(f.tangent0 * f.sphereCentre.z - glm::dvec2(f.sphereCentre),
                                      f.tangentPerPixel * f.sphereCentre.z));
    block.viewport = glm::vec4(
        glm::dvec4(f.viewportCentre, 0.0,
                   plan.variant.fetchesTarget ? saturatedAlpha(plan) : plan.terminationAlpha));
    const TableAxis axis = tableAxis(scene.texels(), scene.table());
    const ClassifiedTexels* classified = scene.classified();
    block.tableMap = packed({axis.texelsPerSampled, axis.firstSampled,
                             classified != nullptr ? 1.0 / classified->referenceLengthMm
                                                   : scene.table().extinctionPerMm},
                            axis.lastTexel);
    if (const PreintegratedTable* table = scene.preintegrated()) {
        const int last = table->size() - 1;
        block.tableEnds = {table->at(0, 0), table->at(last, last)};
    }
    block.decode = decodeWeights(scene.texels().format);
    if (scene.skip().exists()) {
        fillSkip(block, scene.skip(), scene.geometry().dims);
    }
    if (plan.variant.shaded) {
        fillShading(block, scene.look().shading, scene.geometry(), scene.texels().valueScale);
    }
    block.counts.y = plan.layersPerPlane;
    block.jitter = {glm::ivec2(f.viewportCorner), 0, 0};
    return block;
}

} // namespace slabcast

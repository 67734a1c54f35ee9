#include "core/frame/frame_block.h"

#include <algorithm>

#include "core/frame/scene.h"
#include "core/transfer/table_axis.h"

namespace slabcast {

namespace {

/// smoothstep() needs two different edges, also for data without any gradient.
constexpr double kLeastGradient = 1e-30;

glm::vec4 packed(glm::dvec3 xyz, double w) {
    return glm::vec4(glm::dvec4(xyz, w));
}

/// Sampled value of an exact texel from what texelFetch returns in r and g.
glm::vec4 decodeWeights(TexelFormat format) {
    return format == TexelFormat::Rg8Exact ? glm::vec4(255.0F * 256.0F, 255.0F, 0.0F, 0.0F)
                                           : glm::vec4(1.0F, 0.0F, 0.0F, 0.0F);
}

void fillSkip(FrameBlock& block, const ProximityCloud& cloud, glm::ivec3 dims) {
    block.skipMap =
        packed(glm::dvec3(dims) / static_cast<double>(cloud.blockEdgeVoxels), cloud.quantumMm);
    block.skipBlocks = glm::ivec4(cloud.blocks - 1, 0);
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
    const bool shells = f.lattice.kind == LatticeKind::Shells;
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
    block.viewport =
        glm::vec4(glm::dvec4(f.viewportCentre, shells ? 1.0 : 0.0, plan.terminationAlpha));
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
    if (scene.cloud() != nullptr) {
        fillSkip(block, *scene.cloud(), scene.geometry().dims);
    }
    if (scene.look().shading) {
        fillShading(block, *scene.look().shading, scene.geometry(), scene.texels().valueScale);
    }
    block.counts.z = plan.layersPerPlane;
    block.jitter = {glm::ivec2(f.viewportCorner), f.lattice.jittered ? 1 : 0, 0};
    return block;
}

} // namespace slabcast

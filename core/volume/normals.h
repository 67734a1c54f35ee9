#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/volume/texels.h"

namespace slabcast {

/// How far baked normals point from the gradient by six samples of the field, over places spread
/// evenly through the volume where the gradient is above a floor. Normals light both sides alike:
/// no angle is above 90 degrees.
struct NormalsError {
    double meanDegrees = 0.0;
    double percentile95Degrees = 0.0; // 95 % of the places are off by less
    int places = 0;
};

/// The gradient of every voxel in four signed bytes: xyz its direction in patient space, as long as
/// w says; w the root of its share of `steepestPerMm`. Filtered between voxels, xyz is a direction
/// to which steep voxels add more than flat ones. The root gives weak gradients digits: one of a
/// hundredth of the steepest is off by at most 4 degrees of rounding.
/// Source: texels with normals as in Rezk-Salama and Kolb 2005, with steepness beside them.
struct NormalTexels {
    glm::ivec3 dims{0};
    double steepestPerMm = 1.0;      // data units; steeper ones are clamped
    std::vector<glm::i8vec4> texels; // x fastest
    NormalsError error;

    /// As the GPU filters them, in float64.
    glm::dvec4 at(glm::dvec3 uvw) const;
    /// Gradient per mm that such a texel stands for; its direction alone is of any length.
    double steepnessPerMm(const glm::dvec4& texel) const;
};

/// Central differences of the stored texels, one voxel to each side, clamped at the edge. Also
/// measures the error, above `floorPerMm`. Memory: 4 bytes a voxel. Cost: one pass, all cores, and
/// 16,384 places that one core looks at.
/// Contract: steepestPerMm > 0. Tested by: normals_test.cpp
NormalTexels bakeNormals(const Texels& texels, const VolumeGeometry& geometry, double steepestPerMm,
                         double floorPerMm);

} // namespace slabcast

#pragma once

#include "core/reference/formula_ray.h"
#include "core/view/view.h"
#include "core/volume/volume.h"

namespace slabcast {

// What refinement is measured on: a cube of kCubeMm whose field is known everywhere.

inline constexpr double kCubeMm = 64.0;

/// The Marschner-Lobb signal with one wave instead of six, so that eight voxels an edge resolve it,
/// under a single ramp of opacity and colour over all its values.
FormulaInput refinedInput();

VolumeGeometry refinedCube(int edgeVoxels);

/// Where along an edge of the cube a voxel is taken, in [0, 1].
using VoxelPlace = double (*)(int voxel, int edgeVoxels);
double voxelCentre(int voxel, int edgeVoxels);
/// A field in float32 voxels.
Volume refinedVolume(const FormulaField& field, int edgeVoxels, VoxelPlace place = voxelCentre);

inline constexpr OrbitCamera kRefinedCamera{35.0, 25.0, 2.5}; // no face is seen edge-on
inline constexpr double kRefinedFovDegrees = 40.0;            // all of the cube
View refinedView(double fovDegrees);

/// What a picture of edge^2 pixels of the field itself shows, free of step and grid.
std::vector<glm::dvec4> refinedTruth(const FormulaInput& input, int edge);
inline constexpr int kRefinedPieces = 8; // of a ray's integral: so many and twice agree to 1e-13

/// Over R, G, B and alpha of all pixels.
double rmseOf(const std::vector<glm::dvec4>& picture, const std::vector<glm::dvec4>& reference);

} // namespace slabcast

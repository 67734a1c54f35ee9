#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/build_stages.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/volume/volume.h"

namespace slabcast {

/// What the transform counts in, the same on every builder: lengths are whole 256ths of a quantum,
/// each axis' step per block rounded down, and squares of them fill 32 bits.
struct ProximityUnits {
    static constexpr std::int64_t kPerQuantum = 256;
    static constexpr std::int64_t kFar = 254 * kPerQuantum; // from here on a byte holds 255
    static constexpr auto kFarSquared = std::uint32_t(kFar * kFar);

    std::array<std::int64_t, 3> stepOfBlock{}; // along each axis, at most kFar
    double quantaPerUnit = 0.0;                // less where sheared axes make directions shorter

    int wholeQuanta(std::uint32_t squared) const {
        return int(std::sqrt(double(squared)) * quantaPerUnit);
    }
};

ProximityUnits proximityUnits(const VolumeGeometry& geometry, int blockEdgeVoxels);

/// Euclidean distance to the closest place that the TF makes visible. Box-to-box lower bounds:
/// exact Euclidean transform (separable lower envelopes) of the occupied blocks grown by one block,
/// so that the distance between two blocks counts the gap between them; anisotropic spacing
/// included, sheared axes by the shortest that they make any direction. Cost: O(voxels) for
/// occupancy, O(blocks) per axis for the transform; all cores. Stops early if cancelled. Fails:
/// InvalidArgument (block edge not 1, 2, 4 or 8), Internal where cancelled. Source: Tukora 2020,
/// section 2.3 (proximity clouds); the cell rule is ours. Tested by: proximity_cloud_test.cpp
Result<FreeLengths> buildProximityCloud(const CellVisibility& visibility,
                                        const VolumeGeometry& geometry, int blockEdgeVoxels,
                                        const CancelToken* cancel = nullptr);

/// The same in stages, from the ranges of the blocks: O(blocks).
BuildStages proximityStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                            const CellVisibility& visibility, const VolumeGeometry& geometry,
                            FreeLengths& result);

/// The lengths alone, of a grid whose bytes are 0 where occupied and else 255.
BuildStages proximityStages(const VolumeGeometry& geometry, FreeLengths& marked);

} // namespace slabcast

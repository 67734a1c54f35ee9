#pragma once

#include <memory>

#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/volume/volume.h"

namespace slabcast {

/// What structures are built from.
struct SkipSource {
    const TexelCodes& codes;
    const CellVisibility& visibility;
    const VolumeGeometry& geometry;
};

/// A skip structure under a TF, on the host: what its texture is made from, and its uniforms. Cheap
/// to copy.
struct BuiltSkip {
    SkipOptions options;                        // structure None: nothing was built
    std::shared_ptr<const FreeLengths> lengths; // of grids; of partitioned maps as merged
    std::shared_ptr<const Octree> octree;
    NodeTest test;                 // what the TF makes of the octree's nodes
    double occupiedFraction = 1.0; // of blocks or leaves
    int generation = 0;            // of what the texture holds; unique in this process
    double buildMs = 0.0;          // all that it took, the first TF included

    bool exists() const { return options.structure != SkipStructure::None; }
};

std::int64_t gpuBytes(const BuiltSkip& skip);

/// Builds on the CPU, on all cores. Fails: as check() and the structures' builders. Tested by:
/// skip_equality_gl_test.cpp
Result<BuiltSkip> buildSkip(const SkipSource& source, const SkipOptions& options,
                            const CancelToken* cancel = nullptr);

} // namespace slabcast

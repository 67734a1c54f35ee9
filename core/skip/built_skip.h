#pragma once

#include <memory>
#include <variant>

#include "core/skip/bitfield_octree.h"
#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/skip/partitioned_maps.h"
#include "core/skip/skip_layout.h"
#include "core/skip/visible_values.h"
#include "core/volume/volume.h"

namespace slabcast {

/// What structures are built from.
struct SkipSource {
    const TexelCodes& codes;
    const Texels& texels; // its scale and bias
    const CellVisibility& visibility;
    const VolumeGeometry& geometry;
    /// Of the codes at the options' leaf edge and initial level, where it was built already.
    const Octree* minMax = nullptr;
};

/// A skip structure under a TF, on the host: what its texture is made from, and its uniforms. Cheap
/// to copy.
struct BuiltSkip {
    SkipOptions options;                        // structure None: nothing was built
    std::shared_ptr<const FreeLengths> lengths; // of grids; of partitioned maps as merged
    std::shared_ptr<const PartitionedMaps> maps;
    std::shared_ptr<const Octree> octree;
    std::shared_ptr<const SkipLayout> layout; // of the octree's texture
    std::shared_ptr<const ValueBins> bins;    // of a bitfield octree
    NodeTest test;                            // what the TF makes of the octree's nodes
    VisibleValues shown;                      // what a structure of one TF was built for
    double occupiedFraction = 1.0;            // of blocks or leaves
    bool facesAreClear = false;               // none of those at the volume's faces is occupied
    int generation = 0;                       // of what the texture holds; unique in this process
    bool onGpu = false;                       // where it was built
    double buildMs = 0.0;                     // all that the first TF took
    double updateMs = 0.0;                    // what the last TF took, where that was not all

    bool exists() const { return options.structure != SkipStructure::None; }
};

inline BuiltSkip noSkip() {
    return {.options = {.structure = SkipStructure::None}};
}

/// Of the texture, and of partitioned maps on the host.
std::int64_t gpuBytes(const BuiltSkip& skip);
std::int64_t hostBytes(const BuiltSkip& skip);

/// What builders make.
using SkipData = std::variant<std::monostate, FreeLengths, Octree, BitfieldOctree, PartitionedMaps>;

/// The bins that the options ask for. Contract: a bitfield octree or partitioned maps.
ValueBins binsOf(const SkipSource& source, const SkipOptions& options);

/// What was built, under the TF of now. Contract: `data` is what the options ask for.
BuiltSkip asBuilt(const SkipOptions& options, SkipData data, const CellVisibility& visibility);

/// Builds on the CPU, on all cores. Fails: as check() and the structures' builders. Tested by:
/// skip_equality_gl_test.cpp, scene_test.cpp
Result<BuiltSkip> buildSkip(const SkipSource& source, const SkipOptions& options,
                            const CancelToken* cancel = nullptr);

/// A grid that was built elsewhere, for a TF that shows this. Contract: its structure is one of the
/// grids.
BuiltSkip builtSkip(const SkipOptions& options, std::shared_ptr<const FreeLengths> grid,
                    VisibleValues shown);

/// The same structure under another TF. An octree's occupied fraction is that of its finest level
/// of 32,768 nodes or fewer: no less than the leaves', and zero where theirs is. Cost: O(codes),
/// and O(blocks x partitions) where maps are merged. Contract: the structure does not depend on the
/// TF.
BuiltSkip underTransfer(BuiltSkip skip, const CellVisibility& visibility);

} // namespace slabcast

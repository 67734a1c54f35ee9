#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "core/base/error.h"

namespace slabcast {

/// The ways to skip empty space.
enum class SkipStructure : std::uint8_t {
    None,
    Blocks,         // free or not, block by block
    Proximity,      // Euclidean free lengths, mm
    Chebyshev,      // max-norm free lengths, blocks
    Partitioned,    // Chebyshev maps of value ranges, merged for a TF
    BooleanOctree,  // occupied or not
    MinMaxOctree,   // range of values
    BitfieldOctree, // which bins of values occur
};

/// How a fragment shader reads a structure.
enum class SkipForm : std::uint8_t {
    None,
    Balls,       // free lengths in mm around a block: proximity
    Boxes,       // free lengths in blocks around a block: blocks, chebyshev, partitioned
    Octree,      // nodes of up to 32 bits, free without a bit in common with one word
    WideOctree,  // the same with nodes of up to 128 bits
    RangeOctree, // nodes of two codes, free outside one range
};

struct SkipStructureInfo {
    SkipStructure structure;
    const char* name;
    bool dependsOnTransfer;     // built anew when the TF changes
    std::span<const int> edges; // of a block or leaf, voxels, that are offered
};

/// One entry per structure, in the order of the enumeration.
std::span<const SkipStructureInfo> skipStructures();
const SkipStructureInfo& infoOf(SkipStructure structure);
const char* name(SkipStructure structure);
const char* name(SkipForm form);
bool isOctree(SkipStructure structure);

enum class Traversal : std::uint8_t {
    Bidirectional, // goes on at the level of the last test, up or down
    TopDown,       // begins every test at the initial level
};

const char* name(Traversal traversal);

/// Parameters of a skip structure. Each field says which structures read it; the others ignore it.
struct SkipOptions {
    SkipStructure structure = SkipStructure::Proximity;
    int blockEdgeVoxels = 4;      // all: edge of a block, or of an octree's leaf
    int bits = 32;                // bitfield octree: bins per node: 8, 16, 32, 64 or 128
    int partitions = 16;          // partitioned maps: 16, 32, 64, 128 or 256
    bool separateMinimum = false; // bitfield octree, partitioned maps: the least value of the data
                                  // has a bin or partition of its own
    /// Bitfield octree, partitioned maps: the data values between which bins or partitions are
    /// laid. Values beyond fall into the first or last one. None: the data's whole range.
    std::optional<std::array<double, 2>> valueRange;
    int initialLevel = 2; // octrees: levels left out, counted from the root
    Traversal traversal = Traversal::Bidirectional;           // octrees
    std::int64_t memoryBudgetBytes = std::int64_t(256) << 20; // partitioned maps

    bool operator==(const SkipOptions&) const = default;
};

/// Blocks, or leaves, that make up a volume, the last one of an axis possibly beyond it.
inline glm::ivec3 blocksOf(glm::ivec3 dims, int edgeVoxels) {
    return (dims + edgeVoxels - 1) / edgeVoxels;
}

/// Fails: InvalidArgument, naming what is offered. Tested by: skip_structure_test.cpp
Result<void> check(const SkipOptions& options);

/// Contract: the options are valid.
SkipForm formOf(const SkipOptions& options);

} // namespace slabcast

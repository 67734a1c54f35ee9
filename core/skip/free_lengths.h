#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace slabcast {

/// How far the way is free around every block, as one byte. 0: a visible cell may be met inside the
/// block. n > 0: the block is free, and from any point of it so is every point closer than n - 1
/// units: mm quanta (Euclidean, a lower bound) or block edges (max-norm: the whole box that the
/// block makes when it is grown by n - 1 blocks). Values above 255 are clamped; where nothing is
/// visible all are 255, of plain blocks 1. Shape: blocks, x fastest; block b spans [b*e, (b+1)*e]
/// in voxel coordinates, the last one possibly beyond the box.
struct FreeLengths {
    glm::ivec3 blocks{0};
    int blockEdgeVoxels = 4;
    double quantumMm = 0.0; // Euclidean; 0: block edges
    std::vector<std::uint8_t> counts;
    std::int64_t occupiedBlocks = 0;

    bool operator==(const FreeLengths&) const = default;
};

} // namespace slabcast

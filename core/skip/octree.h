#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/function_ref.h"

namespace slabcast {

/// What a node says of the visible cells, or values, that meet it grown by one voxel.
enum class NodeContent : std::uint8_t {
    Occupied, // bit 0: a visible cell is among them
    Bits,     // bins of their values: every one from a cell's least corner to its greatest
    Range,    // low half of the word: least code of any corner; high half: greatest
};

struct OctreeLevel {
    glm::ivec3 nodes{0};
    std::vector<std::uint32_t> words; // wordsPerNode each, x fastest
    bool operator==(const OctreeLevel&) const = default;
};

/// A pyramid over leaves of e^3 voxels: node n of level k spans leaves [n 2^k, (n+1) 2^k), the last
/// of an axis possibly beyond the volume. Every level has half the nodes of the one below, rounded
/// up; those above `levels.back()` are left out.
struct Octree {
    NodeContent content = NodeContent::Bits;
    int leafEdgeVoxels = 4;
    int bitsPerNode = 32; // as stored on the GPU: 8 (Occupied, Bits), 16, 32 (Bits, Range), 64, 128
    std::vector<OctreeLevel> levels; // leaves first

    int wordsPerNode() const { return bitsPerNode <= 32 ? 1 : bitsPerNode / 32; }
    int coarsest() const { return static_cast<int>(levels.size()) - 1; }
    const std::uint32_t* node(int level, glm::ivec3 n) const {
        const glm::ivec3 nodes = levels[level].nodes;
        return levels[level].words.data() +
               ((std::int64_t(n.z) * nodes.y + n.y) * nodes.x + n.x) * wordsPerNode();
    }
    bool operator==(const Octree&) const = default;
};

/// What a TF makes of nodes. Occupied and Bits: free without a bit in common with `words`. Range:
/// free outside of the codes [words.x, words.y].
struct NodeTest {
    glm::uvec4 words{0};
    bool operator==(const NodeTest&) const = default;
};

/// A node of the content Range.
struct NodeRange {
    std::uint32_t least;
    std::uint32_t greatest;

    static NodeRange of(std::uint32_t word) { return {word & 0xffffU, word >> 16}; }
    std::uint32_t word() const { return least | greatest << 16; }
};

bool isFree(const Octree& octree, const std::uint32_t* node, const NodeTest& test);

/// Levels from the root down to the leaves, both counted: 1 + ceil(log2(most leaves of an axis)).
int levelsToRoot(glm::ivec3 leaves);

/// Levels that are left where `initialLevel` of them are left out from the root: the leaves always.
int keptLevels(glm::ivec3 leaves, int initialLevel);

/// Nodes of a level that are not free, found from the coarsest level down. Cost: O(those, and their
/// ancestors). Tested by: octree_test.cpp
std::vector<glm::ivec3> visibleNodes(const Octree& octree, const NodeTest& test, int level);

/// The same one by one, and how many; allocate nothing.
void forVisibleNodes(const Octree& octree, const NodeTest& test, int level,
                     FunctionRef<void(glm::ivec3)> visit);
std::int64_t countVisibleNodes(const Octree& octree, const NodeTest& test, int level);

std::int64_t visibleLeaves(const Octree& octree, const NodeTest& test);

} // namespace slabcast

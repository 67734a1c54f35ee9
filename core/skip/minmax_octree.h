#pragma once

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/octree.h"
#include "core/skip/skip_structure.h"
#include "core/volume/texels.h"

namespace slabcast {

/// Octree of the least and the greatest code, for any TF: of the corners of every cell that meets a
/// node grown by one voxel. Neighbouring cells share corners, and a cell takes every value from its
/// least corner to its greatest; so the cells of a node take every value between the node's ends.
/// What bins they have, and whether a TF makes any of them visible, follows from those alone: the
/// other octrees are derived from this one, node by node, exactly. Cost: O(voxels), all cores.
/// Fails: Internal where cancelled. Source: Faludi et al. 2021, section 4.4.
/// Tested by: octree_test.cpp
Result<Octree> buildMinMaxOctree(const TexelCodes& codes, const SkipOptions& options,
                                 const CancelToken* cancel = nullptr);

/// The TF as one range, from the least code whose cells may show anything to the greatest: gaps
/// between visible values count as visible. Nothing visible: a range that no code is in. Cost:
/// O(log codes).
NodeTest minMaxNodeTest(const CellVisibility& visibility);

/// `shape`, without levels, with the nodes of a min-max octree: each holds what `write(range,
/// words)` makes of one. Cost: O(nodes), all cores.
template <class Write>
Octree derivedOctree(const Octree& minMax, Octree shape, Write write) {
    const int perNode = shape.wordsPerNode();
    for (const OctreeLevel& from : minMax.levels) {
        OctreeLevel to{from.nodes, std::vector<std::uint32_t>(from.words.size() * perNode)};
        parallelFor(
            std::int64_t(from.words.size()), 1 << 15, [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t n = begin; n < end; ++n) {
                    write(NodeRange::of(from.words[std::size_t(n)]), to.words.data() + n * perNode);
                }
            });
        shape.levels.push_back(std::move(to));
    }
    return shape;
}

} // namespace slabcast

#pragma once

#include "core/skip/octree.h"
#include "core/skip/skip_structure.h"

namespace slabcast::test {

/// What one look at an octree decides.
struct OctreeLook {
    int level = 0;      // that was tested
    bool free = false;  // the node
    bool again = false; // neither free nor a leaf: look at `nextLevel` from the same place
    int nextLevel = 0;
};

/// What the shaders do, written for clarity: test the node of `level` that holds the leaf. After a
/// free one go on a level above, after a leaf that is not free at the leaves; top-down always at
/// the coarsest. Source: Faludi et al. 2021, section 3.4, a test at a time.
inline OctreeLook lookAt(const Octree& octree, const NodeTest& test, glm::ivec3 leaf,
                         Traversal traversal, int level) {
    const bool free = isFree(octree, octree.node(level, leaf >> level), test);
    if (!free && level > 0) {
        return {level, false, true, level - 1};
    }
    const int next = traversal == Traversal::TopDown
                         ? octree.coarsest()
                         : std::min(level + (free ? 1 : 0), octree.coarsest());
    return {level, free, false, next};
}

} // namespace slabcast::test

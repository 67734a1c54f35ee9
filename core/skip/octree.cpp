#include "core/skip/octree.h"

#include <algorithm>

#include "core/base/error.h"

namespace slabcast {

namespace {

bool isFree(const Octree& octree, const NodeTest& test, int level, glm::ivec3 node) {
    return isFree(octree, octree.node(level, node), test);
}

/// Calls visit(n) for all n with first <= n < end.
template <class Visit>
void forNodes(glm::ivec3 first, glm::ivec3 end, Visit visit) {
    for (int z = first.z; z < end.z; ++z) {
        for (int y = first.y; y < end.y; ++y) {
            for (int x = first.x; x < end.x; ++x) {
                visit(glm::ivec3(x, y, z));
            }
        }
    }
}

/// Calls visit(child) for the children of `nodes`, nodes of the level above `level`, that are not
/// free.
template <class Visit>
void forVisibleChildren(const Octree& octree, const NodeTest& test, int level,
                        const std::vector<glm::ivec3>& nodes, Visit visit) {
    for (const glm::ivec3 node : nodes) {
        forNodes(2 * node, glm::min(2 * node + 2, octree.levels[level].nodes),
                 [&](glm::ivec3 child) {
                     if (!isFree(octree, test, level, child)) {
                         visit(child);
                     }
                 });
    }
}

} // namespace

bool isFree(const Octree& octree, const std::uint32_t* node, const NodeTest& test) {
    if (octree.content == NodeContent::Range) {
        const NodeRange range = NodeRange::of(*node);
        return range.greatest < test.words.x || range.least > test.words.y;
    }
    std::uint32_t common = 0;
    for (int w = 0; w < octree.wordsPerNode(); ++w) {
        common |= node[w] & test.words[w];
    }
    return common == 0;
}

int levelsToRoot(glm::ivec3 leaves) {
    int levels = 1;
    for (int most = std::max({leaves.x, leaves.y, leaves.z}); most > 1; most = (most + 1) / 2) {
        ++levels;
    }
    return levels;
}

int keptLevels(glm::ivec3 leaves, int initialLevel) {
    SLABCAST_EXPECTS(initialLevel >= 0, initialLevel);
    return std::max(1, levelsToRoot(leaves) - initialLevel);
}

std::vector<glm::ivec3> visibleNodes(const Octree& octree, const NodeTest& test, int level) {
    SLABCAST_EXPECTS(level >= 0 && level <= octree.coarsest(), level);
    std::vector<glm::ivec3> nodes;
    forNodes(glm::ivec3(0), octree.levels.back().nodes, [&](glm::ivec3 node) {
        if (!isFree(octree, test, octree.coarsest(), node)) {
            nodes.push_back(node);
        }
    });
    for (int below = octree.coarsest() - 1; below >= level; --below) {
        std::vector<glm::ivec3> children;
        forVisibleChildren(octree, test, below, nodes,
                           [&](glm::ivec3 child) { children.push_back(child); });
        nodes = std::move(children);
    }
    return nodes;
}

std::int64_t visibleLeaves(const Octree& octree, const NodeTest& test) {
    if (octree.coarsest() == 0) {
        return std::int64_t(visibleNodes(octree, test, 0).size());
    }
    std::int64_t count = 0;
    forVisibleChildren(octree, test, 0, visibleNodes(octree, test, 1),
                       [&](glm::ivec3 /*leaf*/) { ++count; });
    return count;
}

} // namespace slabcast

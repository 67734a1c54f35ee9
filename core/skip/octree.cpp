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

void forVisibleNodes(const Octree& octree, const NodeTest& test, int level,
                     FunctionRef<void(glm::ivec3)> visit) {
    SLABCAST_EXPECTS(level >= 0 && level <= octree.coarsest(), level);
    const auto descend = [&](auto& self, int at, glm::ivec3 first, glm::ivec3 end) -> void {
        forNodes(first, glm::min(end, octree.levels[at].nodes), [&](glm::ivec3 node) {
            if (isFree(octree, test, at, node)) {
                return;
            }
            if (at == level) {
                visit(node);
            } else {
                self(self, at - 1, 2 * node, 2 * node + 2);
            }
        });
    };
    descend(descend, octree.coarsest(), glm::ivec3(0), octree.levels.back().nodes);
}

std::vector<glm::ivec3> visibleNodes(const Octree& octree, const NodeTest& test, int level) {
    std::vector<glm::ivec3> nodes;
    forVisibleNodes(octree, test, level, [&](glm::ivec3 node) { nodes.push_back(node); });
    return nodes;
}

std::int64_t countVisibleNodes(const Octree& octree, const NodeTest& test, int level) {
    std::int64_t count = 0;
    forVisibleNodes(octree, test, level, [&](glm::ivec3 /*node*/) { ++count; });
    return count;
}

std::int64_t visibleLeaves(const Octree& octree, const NodeTest& test) {
    return countVisibleNodes(octree, test, 0);
}

} // namespace slabcast

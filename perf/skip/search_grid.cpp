#include "perf/skip/search_grid.h"

#include "core/skip/octree.h"

namespace slabcast::skipbench {

namespace {

/// Values that a search tries, one list each; an empty one leaves the usual value.
struct Axes {
    std::vector<int> edges, bits, levels;
    std::vector<Traversal> traversals;
};

Axes axesOf(SkipStructure structure, bool quick) {
    if (!isOctree(structure)) {
        return {quick ? std::vector{4, 8} : std::vector{2, 4, 8}, {}, {}, {}};
    }
    Axes axes{quick ? std::vector{4, 8} : std::vector{2, 4, 8, 16},
              {},
              quick ? std::vector{0, 3} : std::vector{0, 1, 2, 3, 4, 5},
              {Traversal::Bidirectional, Traversal::TopDown}};
    if (structure == SkipStructure::BitfieldOctree) {
        axes.bits = quick ? std::vector{16, 32, 64} : std::vector{8, 16, 32, 64, 128};
    }
    return axes;
}

/// Each of the options with each of the values.
template <class T>
void spread(std::vector<SkipOptions>& all, T SkipOptions::*member, const std::vector<T>& values) {
    if (values.empty()) {
        return;
    }
    std::vector<SkipOptions> more;
    for (const SkipOptions& options : all) {
        for (const T value : values) {
            more.push_back(options);
            more.back().*member = value;
        }
    }
    all = std::move(more);
}

} // namespace

std::vector<SkipOptions> searchGrid(SkipStructure structure, glm::ivec3 dims, bool quick) {
    const Axes axes = axesOf(structure, quick);
    std::vector<SkipOptions> all{{.structure = structure}};
    spread(all, &SkipOptions::blockEdgeVoxels, axes.edges);
    spread(all, &SkipOptions::bits, axes.bits);
    spread(all, &SkipOptions::initialLevel, axes.levels);
    spread(all, &SkipOptions::traversal, axes.traversals);
    const auto beyondTheLeaves = [dims](const SkipOptions& o) {
        const glm::ivec3 leaves = blocksOf(dims, o.blockEdgeVoxels);
        return isOctree(o.structure) && o.initialLevel >= levelsToRoot(leaves);
    };
    std::erase_if(all, beyondTheLeaves);
    return all;
}

} // namespace slabcast::skipbench

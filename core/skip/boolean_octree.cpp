#include "core/skip/boolean_octree.h"

namespace slabcast {

Octree booleanOctree(const Octree& minMax, const CellVisibility& visibility) {
    return derivedOctree(minMax,
                         {.content = NodeContent::Occupied,
                          .leafEdgeVoxels = minMax.leafEdgeVoxels,
                          .bitsPerNode = 8},
                         [&](NodeRange range, std::uint32_t* word) {
                             *word = visibility.visible(std::uint16_t(range.least),
                                                        std::uint16_t(range.greatest));
                         });
}

Result<Octree> buildBooleanOctree(const CellVisibility& visibility, const SkipOptions& options,
                                  const CancelToken* cancel) {
    return buildMinMaxOctree(*visibility.texels, options, cancel).map([&](const Octree& minMax) {
        return booleanOctree(minMax, visibility);
    });
}

NodeTest booleanNodeTest() {
    return {glm::uvec4(1, 0, 0, 0)};
}

} // namespace slabcast

#include "core/skip/built_skip.h"

#include <atomic>
#include <chrono>

#include "core/skip/proximity_cloud.h"
#include "core/skip/skip_texture.h"

namespace slabcast {

namespace {

int nextGeneration() {
    static std::atomic<int> last{0};
    return ++last;
}

/// Keeps the grid, or hands on what went wrong.
Result<void> keep(BuiltSkip& skip, Result<FreeLengths> grid) {
    if (!grid) {
        return tl::unexpected(grid.error());
    }
    const glm::i64vec3 n(grid->blocks);
    skip.occupiedFraction =
        static_cast<double>(grid->occupiedBlocks) / static_cast<double>(n.x * n.y * n.z);
    skip.lengths = std::make_shared<const FreeLengths>(std::move(*grid));
    return {};
}

Result<void> build(BuiltSkip& skip, const SkipSource& s, const CancelToken* cancel) {
    switch (skip.options.structure) {
    default:
        return {};
    case SkipStructure::Proximity:
        return keep(skip, buildProximityCloud(s.visibility, s.geometry,
                                              skip.options.blockEdgeVoxels, cancel));
    }
}

} // namespace

std::int64_t gpuBytes(const BuiltSkip& skip) {
    return skip.octree    ? gpuBytes(*skip.octree)
           : skip.lengths ? gpuBytes(*skip.lengths)
                          : 0;
}

Result<BuiltSkip> buildSkip(const SkipSource& source, const SkipOptions& options,
                            const CancelToken* cancel) {
    if (Result<void> ok = check(options); !ok) {
        return tl::unexpected(ok.error());
    }
    const auto start = std::chrono::steady_clock::now();
    BuiltSkip skip{.options = options};
    if (Result<void> built = build(skip, source, cancel); !built) {
        return tl::unexpected(built.error());
    }
    skip.generation = nextGeneration();
    skip.buildMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return skip;
}

} // namespace slabcast

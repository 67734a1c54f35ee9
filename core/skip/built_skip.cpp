#include "core/skip/built_skip.h"

#include <atomic>

#include "core/base/stopwatch.h"
#include "core/skip/blocks.h"
#include "core/skip/boolean_octree.h"
#include "core/skip/chebyshev.h"
#include "core/skip/minmax_octree.h"
#include "core/skip/proximity_cloud.h"
#include "core/skip/skip_layout.h"

namespace slabcast {

namespace {

int nextGeneration() {
    static std::atomic<int> last{0};
    return ++last;
}

double fractionOf(std::int64_t occupied, glm::ivec3 blocks) {
    const glm::dvec3 n(blocks);
    return static_cast<double>(occupied) / (n.x * n.y * n.z);
}

bool isAtFace(glm::ivec3 place, glm::ivec3 count) {
    return glm::any(glm::equal(place, glm::ivec3(0))) || glm::any(glm::equal(place, count - 1));
}

/// Whether all blocks at the volume's faces are free. Cost: O(those).
bool facesAreClear(const FreeLengths& grid) {
    const glm::ivec3 n = grid.blocks;
    glm::ivec3 at(0);
    for (at.z = 0; at.z < n.z; ++at.z) {
        for (at.y = 0; at.y < n.y; ++at.y) {
            const bool inner = !isAtFace({1, at.y, at.z}, {3, n.y, n.z});
            for (at.x = 0; at.x < n.x; at.x += inner ? std::max(n.x - 1, 1) : 1) {
                const std::int64_t row = std::int64_t(at.z) * n.y + at.y;
                if (grid.counts[static_cast<std::size_t>(row * n.x + at.x)] == 0) {
                    return false;
                }
            }
        }
    }
    return true;
}

// Each takes one kind of data into its place.

void keep(BuiltSkip& /*skip*/, std::monostate /*nothing*/) {}

void keep(BuiltSkip& skip, std::shared_ptr<const FreeLengths> grid) {
    skip.occupiedFraction = fractionOf(grid->occupiedBlocks, grid->blocks);
    skip.facesAreClear = facesAreClear(*grid);
    skip.lengths = std::move(grid);
    skip.generation = nextGeneration();
}

void keep(BuiltSkip& skip, FreeLengths grid) {
    keep(skip, std::make_shared<const FreeLengths>(std::move(grid)));
}

void keep(BuiltSkip& skip, Octree octree) {
    skip.layout = std::make_shared<const SkipLayout>(layoutOf(octree));
    skip.octree = std::make_shared<const Octree>(std::move(octree));
    skip.generation = nextGeneration();
}

void keep(BuiltSkip& skip, BitfieldOctree built) {
    skip.bins = std::make_shared<const ValueBins>(std::move(built.bins));
    keep(skip, std::move(built.octree));
}

void keep(BuiltSkip& skip, PartitionedMaps maps) {
    skip.maps = std::make_shared<const PartitionedMaps>(std::move(maps));
}

std::optional<std::array<double, 2>> sampledRange(const SkipSource& s, const SkipOptions& o) {
    if (!o.valueRange) {
        return std::nullopt;
    }
    const auto sampled = [&](double value) {
        return (value - s.texels.valueBias) / s.texels.valueScale;
    };
    return std::array{sampled((*o.valueRange)[0]), sampled((*o.valueRange)[1])};
}

Result<SkipData> build(const SkipSource& s, const SkipOptions& o, const CancelToken* cancel) {
    switch (o.structure) {
    case SkipStructure::None:
        return SkipData();
    case SkipStructure::Blocks:
        return buildBlocks(s.visibility, o.blockEdgeVoxels, cancel);
    case SkipStructure::Proximity:
        return buildProximityCloud(s.visibility, s.geometry, o.blockEdgeVoxels, cancel);
    case SkipStructure::Chebyshev:
        return buildChebyshev(s.visibility, o.blockEdgeVoxels, cancel);
    case SkipStructure::Partitioned:
        return buildPartitionedMaps(s.codes, binsOf(s, o), o, cancel);
    case SkipStructure::BooleanOctree:
        return s.minMax != nullptr ? booleanOctree(*s.minMax, s.visibility)
                                   : buildBooleanOctree(s.visibility, o, cancel);
    case SkipStructure::MinMaxOctree:
        return s.minMax != nullptr ? *s.minMax : buildMinMaxOctree(s.codes, o, cancel);
    case SkipStructure::BitfieldOctree:
        return s.minMax != nullptr ? bitfieldOctree(*s.minMax, binsOf(s, o))
                                   : buildBitfieldOctree(s.codes, binsOf(s, o), o, cancel);
    }
    contractBreach(__func__, "a skip structure", static_cast<double>(o.structure));
}

NodeTest testOf(const BuiltSkip& skip, const CellVisibility& visibility) {
    switch (skip.octree->content) {
    case NodeContent::Occupied:
        return booleanNodeTest();
    case NodeContent::Range:
        return minMaxNodeTest(visibility);
    case NodeContent::Bits:
        return bitfieldNodeTest(*skip.bins, visibility);
    }
    contractBreach(__func__, "a node's content", static_cast<double>(skip.octree->content));
}

/// Nodes that are counted when a TF changes: as many take a fraction of a millisecond.
constexpr std::int64_t kCountedNodes = 1 << 15;

int countedLevel(const Octree& octree) {
    int level = 0;
    const auto nodes = [&] {
        const glm::i64vec3 n(octree.levels[level].nodes);
        return n.x * n.y * n.z;
    };
    while (level < octree.coarsest() && nodes() > kCountedNodes) {
        ++level;
    }
    return level;
}

/// How many nodes of a level are visible, and whether any of them is at a face.
void countVisible(BuiltSkip& skip, int level) {
    const glm::ivec3 nodes = skip.octree->levels[level].nodes;
    std::int64_t visible = 0;
    skip.facesAreClear = true;
    forVisibleNodes(*skip.octree, skip.test, level, [&](glm::ivec3 node) {
        ++visible;
        skip.facesAreClear &= !isAtFace(node, nodes);
    });
    skip.occupiedFraction = fractionOf(visible, nodes);
}

/// What a TF changes: the merged map, or the test of nodes.
void apply(BuiltSkip& skip, const CellVisibility& visibility) {
    const Stopwatch watch;
    if (skip.maps) {
        keep(skip, merged(*skip.maps, visibleBins(skip.maps->bins, visibility)));
    } else if (skip.octree) {
        skip.test = testOf(skip, visibility);
        countVisible(skip, countedLevel(*skip.octree));
    }
    skip.updateMs = watch.ms();
}

} // namespace

std::int64_t gpuBytes(const BuiltSkip& skip) {
    return skip.octree ? gpuBytes(*skip.octree) : skip.lengths ? gpuBytes(*skip.lengths) : 0;
}

std::int64_t hostBytes(const BuiltSkip& skip) {
    return skip.maps ? static_cast<std::int64_t>(skip.maps->distances.size()) : 0;
}

ValueBins binsOf(const SkipSource& s, const SkipOptions& o) {
    const int count = o.structure == SkipStructure::Partitioned ? o.partitions : o.bits;
    return valueBins(s.codes, codeRange(s.codes), count, o.separateMinimum, sampledRange(s, o));
}

BuiltSkip asBuilt(const SkipOptions& options, SkipData data, const CellVisibility& visibility) {
    BuiltSkip skip{.options = options};
    std::visit([&](auto& built) { keep(skip, std::move(built)); }, data);
    if (infoOf(options.structure).dependsOnTransfer) {
        skip.shown = visibleValues(visibility);
    }
    apply(skip, visibility);
    return skip;
}

BuiltSkip builtSkip(const SkipOptions& options, std::shared_ptr<const FreeLengths> grid,
                    VisibleValues shown) {
    BuiltSkip skip{.options = options, .shown = std::move(shown)};
    keep(skip, std::move(grid));
    return skip;
}

Result<BuiltSkip> buildSkip(const SkipSource& source, const SkipOptions& options,
                            const CancelToken* cancel) {
    if (Result<void> ok = check(options); !ok) {
        return tl::unexpected(ok.error());
    }
    const Stopwatch watch;
    Result<SkipData> data = build(source, options, cancel);
    if (!data) {
        return tl::unexpected(data.error());
    }
    BuiltSkip skip = asBuilt(options, std::move(*data), source.visibility);
    skip.buildMs = watch.ms();
    return skip;
}

BuiltSkip underTransfer(BuiltSkip skip, const CellVisibility& visibility) {
    SLABCAST_EXPECTS(!infoOf(skip.options.structure).dependsOnTransfer, skip.generation);
    apply(skip, visibility);
    return skip;
}

} // namespace slabcast

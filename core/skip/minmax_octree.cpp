#include "core/skip/minmax_octree.h"

#include <algorithm>

namespace slabcast {

namespace {

struct Span {
    int first;
    int end;
};

/// Corners along one axis of the cells that meet leaf b grown by one voxel, [b*e - 1, (b+1)*e + 1],
/// touching included: cell j spans [j+0.5, j+1.5] between voxels j and j+1. The half cells at the
/// ends of an axis have corners of their full neighbours.
Span voxelsNearLeaf(int leaf, int edge, int dims) {
    return {std::max(0, leaf * edge - 2), std::min(dims, (leaf + 1) * edge + 2)};
}

constexpr auto kLesser = [](auto a, auto b) { return std::min(a, b); };
constexpr auto kGreater = [](auto a, auto b) { return std::max(a, b); };

/// Picks one of `span` rows place by place: row r is the `count` places from rows + r * count.
template <class Code, class Pick>
void pickOfRows(const Code* rows, std::int64_t count, Span span, Pick pick, Code* __restrict to) {
    const Code* row = rows + span.first * count;
    std::copy(row, row + count, to);
    for (int r = span.first + 1; r < span.end; ++r) {
        row += count;
        for (std::int64_t i = 0; i < count; ++i) {
            to[i] = pick(to[i], row[i]);
        }
    }
}

/// Picks along a row for each of its leaves: as voxelsNearLeaf(), in runs of four voxels.
template <class Code, class Pick>
class RowOfLeaves {
public:
    RowOfLeaves(int dims, int edge, int leaves, Pick pick)
        : dims_(dims), edge_(edge), leaves_(leaves), pick_(pick), padded_(leaves * edge + 4),
          ofFour_(leaves * edge + 1) {}

    /// Where the row is to be laid.
    Code* row() { return padded_.data() + 2; }

    void pick(Code* __restrict to) {
        // Beyond its ends a row goes on as it ends, which adds nothing to what is picked.
        std::fill(padded_.begin(), padded_.begin() + 2, padded_[2]);
        std::fill(padded_.begin() + 2 + dims_, padded_.end(), padded_[1 + dims_]);
        const Code* from = padded_.data();
        Code* __restrict four = ofFour_.data();
        for (std::size_t i = 0; i < ofFour_.size(); ++i) {
            four[i] = pick_(pick_(from[i], from[i + 1]), pick_(from[i + 2], from[i + 3]));
        }
        const std::int64_t edge = edge_;
        for (std::int64_t x = 0; x < leaves_; ++x) {
            to[x] = pick_(four[x * edge], four[x * edge + edge]);
        }
        for (std::int64_t i = 4; i < edge; i += 4) {
            for (std::int64_t x = 0; x < leaves_; ++x) {
                to[x] = pick_(to[x], four[x * edge + i]);
            }
        }
    }

private:
    int dims_;
    int edge_;
    int leaves_;
    Pick pick_;
    std::vector<Code> padded_; // two voxels before the first leaf to two after the last
    std::vector<Code> ofFour_;
};

/// One code for each leaf of the slices of leaves `slab`: reduced in x and y slice by slice of
/// voxels, then in z.
template <class Code, class Pick>
std::vector<Code> pickOfSlab(const Code* codes, glm::ivec3 dims, int edge, glm::ivec3 leaves,
                             Span slab, Pick pick) {
    const auto perSlice = std::int64_t(leaves.x) * leaves.y;
    const int first = voxelsNearLeaf(slab.first, edge, dims.z).first;
    const int end = voxelsNearLeaf(slab.end - 1, edge, dims.z).end;
    std::vector<Code> slices(std::size_t((end - first) * perSlice));
    RowOfLeaves<Code, Pick> along(dims.x, edge, leaves.x, pick);
    Code* row = slices.data();
    for (int z = first; z < end; ++z) {
        const Code* slice = codes + std::int64_t(z) * dims.y * dims.x;
        for (int y = 0; y < leaves.y; ++y, row += leaves.x) {
            pickOfRows(slice, dims.x, voxelsNearLeaf(y, edge, dims.y), pick, along.row());
            along.pick(row);
        }
    }
    std::vector<Code> picked(std::size_t((slab.end - slab.first) * perSlice));
    for (int z = slab.first; z < slab.end; ++z) {
        const Span near = voxelsNearLeaf(z, edge, dims.z);
        pickOfRows(slices.data(), perSlice, {near.first - first, near.end - first}, pick,
                   picked.data() + (z - slab.first) * perSlice);
    }
    return picked;
}

Result<OctreeLevel> rangesOfLeaves(const TexelCodes& codes, int edge, const CancelToken* cancel) {
    const glm::ivec3 leaves = blocksOf(codes.dims, edge);
    const auto perSlice = std::int64_t(leaves.x) * leaves.y;
    OctreeLevel level{leaves, std::vector<std::uint32_t>(std::size_t(leaves.z * perSlice))};
    const auto reduceSlab = [&](std::int64_t begin, std::int64_t end) {
        const Span slab{int(begin), int(end)};
        codes.visit([&](const auto* code) {
            const auto least = pickOfSlab(code, codes.dims, edge, leaves, slab, kLesser);
            const auto greatest = pickOfSlab(code, codes.dims, edge, leaves, slab, kGreater);
            std::transform(least.begin(), least.end(), greatest.begin(),
                           level.words.data() + begin * perSlice, [](auto low, auto high) {
                               return NodeRange{low, high}.word();
                           });
        });
    };
    // Slabs share the four slices between them, and a small volume is not worth a second thread.
    constexpr std::int64_t kSlices = 32;
    constexpr std::int64_t kVoxels = 1 << 16;
    const std::int64_t voxelsPerSlice = std::int64_t(codes.dims.x) * codes.dims.y;
    const std::int64_t slices = std::max(kSlices, kVoxels / voxelsPerSlice);
    if (!parallelFor(leaves.z, std::max<std::int64_t>(1, slices / edge), reduceSlab, cancel)) {
        return fail(ErrorCode::Internal, "skip structure: cancelled; build it again when needed");
    }
    return level;
}

/// The level above: a node holds what its children hold.
OctreeLevel parentsOf(const OctreeLevel& children) {
    const glm::ivec3 from = children.nodes;
    const glm::ivec3 to = (from + 1) / 2;
    OctreeLevel level{to, std::vector<std::uint32_t>(std::size_t(to.x) * to.y * to.z,
                                                     NodeRange{0xffffU, 0}.word())};
    const std::uint32_t* child = children.words.data();
    for (int z = 0; z < from.z; ++z) {
        for (int y = 0; y < from.y; ++y) {
            std::uint32_t* row = level.words.data() + (std::int64_t(z / 2) * to.y + y / 2) * to.x;
            for (int x = 0; x < from.x; ++x) {
                const NodeRange a = NodeRange::of(row[x / 2]);
                const NodeRange b = NodeRange::of(*child++);
                row[x / 2] =
                    NodeRange{std::min(a.least, b.least), std::max(a.greatest, b.greatest)}.word();
            }
        }
    }
    return level;
}

} // namespace

Result<Octree> buildMinMaxOctree(const TexelCodes& codes, const SkipOptions& options,
                                 const CancelToken* cancel) {
    const auto voxels = std::int64_t(codes.dims.x) * codes.dims.y * codes.dims.z;
    SLABCAST_EXPECTS(voxels > 0, voxels);
    SLABCAST_EXPECTS(codes.count() == voxels, voxels);
    SLABCAST_EXPECTS(options.blockEdgeVoxels > 0, options.blockEdgeVoxels);
    Result<OctreeLevel> leaves = rangesOfLeaves(codes, options.blockEdgeVoxels, cancel);
    if (!leaves) {
        return tl::unexpected(leaves.error());
    }
    const int kept = keptLevels(leaves->nodes, options.initialLevel);
    Octree octree{.content = NodeContent::Range,
                  .leafEdgeVoxels = options.blockEdgeVoxels,
                  .bitsPerNode = 32,
                  .levels = {std::move(*leaves)}};
    while (int(octree.levels.size()) < kept) {
        octree.levels.push_back(parentsOf(octree.levels.back()));
    }
    return octree;
}

NodeTest minMaxNodeTest(const CellVisibility& visibility) {
    // A cell [a, b] is visible iff firstVisible[a] <= reach[b], and both rise with the code: then b
    // reaches the first visible texel of all, and one lies at or above a.
    const std::vector<std::uint16_t>& first = visibility.firstVisible;
    const std::vector<std::uint16_t>& reach = visibility.reach;
    const auto least = std::lower_bound(reach.begin(), reach.end(), first.front());
    const auto above = std::upper_bound(first.begin(), first.end(), reach.back());
    // Where nothing is visible, `least` is one more than any code.
    return {glm::uvec4(least - reach.begin(), above - first.begin() - 1, 0, 0)};
}

} // namespace slabcast

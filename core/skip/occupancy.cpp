#include "core/skip/occupancy.h"

#include <algorithm>

namespace slabcast {

namespace {

/// Cell j spans [j+0.5, j+1.5] between the centres of voxels j and j+1. The half cells at the ends
/// of an axis see only a part of what their full neighbour sees, and every block that meets the one
/// within a voxel meets the other: they need no place of their own. Where an axis has one voxel,
/// its two half cells count as one cell.
int cellsAlong(int dims) {
    return std::max(1, dims - 1);
}

struct Range {
    int first;
    int end;
};

/// Cells that meet block b grown by one voxel, [b*e - 1, (b+1)*e + 1], touching included.
Range cellsNearBlock(int block, int edge, int cells) {
    return {std::max(0, block * edge - 2), std::min(cells, (block + 1) * edge + 1)};
}

/// Smallest and largest code of each cell's corners in one row of cells, from the four rows of
/// voxels around it.
struct RowRanges {
    std::vector<std::uint16_t> lowest;
    std::vector<std::uint16_t> highest;

    explicit RowRanges(int voxels) : lowest(voxels), highest(voxels) {}

    void set(const std::uint16_t* const (&rows)[4]) {
        const int voxels = int(lowest.size());
        const std::uint16_t* a = rows[0];
        const std::uint16_t* b = rows[1];
        const std::uint16_t* c = rows[2];
        const std::uint16_t* d = rows[3];
        std::uint16_t* __restrict low = lowest.data();
        std::uint16_t* __restrict high = highest.data();
        for (int x = 0; x < voxels; ++x) {
            low[x] = std::min(std::min(a[x], b[x]), std::min(c[x], d[x]));
            high[x] = std::max(std::max(a[x], b[x]), std::max(c[x], d[x]));
        }
        for (int x = 0; x + 1 < voxels; ++x) {
            low[x] = std::min(low[x], low[x + 1]);
            high[x] = std::max(high[x], high[x + 1]);
        }
    }
};

void markVisible(const CellVisibility& visibility, const RowRanges& ranges, int cells,
                 std::uint8_t* marks) {
    constexpr int kRun = 64;
    for (int first = 0; first < cells; first += kRun) {
        const int end = std::min(first + kRun, cells);
        // A run's range contains those of its cells: in air and far from the band two lookups
        // settle all of it.
        std::uint16_t lowest = 65535;
        std::uint16_t highest = 0;
        for (int x = first; x < end; ++x) {
            lowest = std::min(lowest, ranges.lowest[x]);
            highest = std::max(highest, ranges.highest[x]);
        }
        if (!visibility.visible(lowest, highest)) {
            std::fill(marks + first, marks + end, std::uint8_t(0));
            continue;
        }
        for (int x = first; x < end; ++x) {
            marks[x] = visibility.visible(ranges.lowest[x], ranges.highest[x]);
        }
    }
}

/// One byte per cell of a slice: 1 where visible.
void markSlice(const CellVisibility& visibility, int z, RowRanges& ranges,
               std::vector<std::uint8_t>& marks) {
    const glm::ivec3 dims = visibility.texels->dims;
    const std::uint16_t* codes = visibility.texels->codes.data();
    const auto row = [&](int y, int slice) {
        const int yInside = std::min(y, dims.y - 1);
        const int zInside = std::min(slice, dims.z - 1);
        return codes + (std::int64_t(zInside) * dims.y + yInside) * dims.x;
    };
    const int cells = cellsAlong(dims.x);
    for (int y = 0; y < cellsAlong(dims.y); ++y) {
        ranges.set({row(y, z), row(y + 1, z), row(y, z + 1), row(y + 1, z + 1)});
        markVisible(visibility, ranges, cells, marks.data() + std::int64_t(y) * cells);
    }
}

/// merged[i] = 1 where any of the rows in `range` has a mark at i.
void mergeRows(const std::uint8_t* rows, std::int64_t length, Range range,
               std::uint8_t* __restrict merged) {
    std::fill(merged, merged + length, std::uint8_t(0));
    for (int r = range.first; r < range.end; ++r) {
        const std::uint8_t* row = rows + r * length;
        for (std::int64_t i = 0; i < length; ++i) {
            merged[i] |= row[i];
        }
    }
}

/// From the cells of one slice to its blocks in x and y.
void reduceSlice(const std::vector<std::uint8_t>& marks, glm::ivec2 cells, glm::ivec2 blocks,
                 int edge, std::uint8_t* out) {
    std::vector<std::uint8_t> merged(cells.x);
    for (int y = 0; y < blocks.y; ++y) {
        mergeRows(marks.data(), cells.x, cellsNearBlock(y, edge, cells.y), merged.data());
        for (int x = 0; x < blocks.x; ++x) {
            const Range near = cellsNearBlock(x, edge, cells.x);
            *out++ = std::any_of(merged.begin() + near.first, merged.begin() + near.end,
                                 [](std::uint8_t mark) { return mark != 0; });
        }
    }
}

} // namespace

Result<Occupancy> occupiedBlocks(const CellVisibility& visibility, int blockEdgeVoxels,
                                 const CancelToken* cancel) {
    const glm::ivec3 dims = visibility.texels->dims;
    const int edge = blockEdgeVoxels;
    SLABCAST_EXPECTS(edge > 0, edge);
    const auto voxels = std::int64_t(dims.x) * dims.y * dims.z;
    SLABCAST_EXPECTS(std::int64_t(visibility.texels->codes.size()) == voxels, voxels);
    SLABCAST_EXPECTS(voxels > 0, voxels);
    const glm::ivec3 blocks = (dims + edge - 1) / edge;
    const glm::ivec3 cells(cellsAlong(dims.x), cellsAlong(dims.y), cellsAlong(dims.z));
    const auto blocksPerSlice = std::int64_t(blocks.x) * blocks.y;

    // Each slice of cells is looked at once and reduced in x and y; blocks then gather the slices
    // that they meet.
    std::vector<std::uint8_t> slices(cells.z * blocksPerSlice);
    const auto reduceSlices = [&](std::int64_t begin, std::int64_t end) {
        RowRanges ranges(dims.x);
        std::vector<std::uint8_t> marks(std::int64_t(cells.x) * cells.y);
        for (std::int64_t z = begin; z < end; ++z) {
            markSlice(visibility, int(z), ranges, marks);
            reduceSlice(marks, cells, blocks, edge, slices.data() + z * blocksPerSlice);
        }
    };
    Occupancy occupancy{blocks, std::vector<std::uint8_t>(blocks.z * blocksPerSlice)};
    const auto gatherSlices = [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t z = begin; z < end; ++z) {
            mergeRows(slices.data(), blocksPerSlice, cellsNearBlock(int(z), edge, cells.z),
                      occupancy.occupied.data() + z * blocksPerSlice);
        }
    };
    if (!parallelFor(cells.z, 2, reduceSlices, cancel) ||
        !parallelFor(blocks.z, 1, gatherSlices, cancel)) {
        return fail(ErrorCode::Internal, "skip structure: cancelled; build it again when needed");
    }
    return occupancy;
}

} // namespace slabcast

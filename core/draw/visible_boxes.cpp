#include "core/draw/visible_boxes.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace slabcast {

namespace {

constexpr int kMacroBlockVoxels = 8;
/// A view transforms the corners of every box: this many take well under a millisecond.
constexpr std::int64_t kMaxBoxes = 16384;

/// Cubes of 2^shift blocks along each axis, some of them occupied.
class MacroGrid {
public:
    MacroGrid(glm::ivec3 blocks, int blockEdgeVoxels) : blockEdgeVoxels_(blockEdgeVoxels) {
        const auto places = [&] {
            const glm::i64vec3 n(size());
            return n.x * n.y * n.z;
        };
        size_ = blocks;
        while (blockEdgeVoxels << shift_ < kMacroBlockVoxels || places() > kMaxBoxes) {
            size_ = (size_ + 1) / 2;
            ++shift_;
        }
        occupied_.resize(places());
    }

    int shift() const { return shift_; }
    glm::ivec3 size() const { return size_; }
    /// Flags of the row of cubes that a row of blocks is in.
    std::uint8_t* row(int y, int z) {
        return occupied_.data() + (std::int64_t(z >> shift_) * size_.y + (y >> shift_)) * size_.x;
    }
    std::vector<VisibleBox> boxes(const VolumeGeometry& geometry, double layerLengthMm) const;

private:
    int blockEdgeVoxels_;
    int shift_ = 0;
    glm::ivec3 size_{0};
    std::vector<std::uint8_t> occupied_; // x fastest
};

/// How far half a layer reaches in uvw: the rows of uvwFromModel bound how far a unit length goes
/// along each axis.
glm::dvec3 reachOfHalfLayer(const VolumeGeometry& geometry, double layerLengthMm) {
    const glm::dmat3 rows = glm::transpose(glm::dmat3(geometry.uvwFromModel()));
    return glm::dvec3(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])) *
               (layerLengthMm / 2.0) +
           1e-3 / glm::dvec3(geometry.dims);
}

std::vector<VisibleBox> MacroGrid::boxes(const VolumeGeometry& geometry,
                                         double layerLengthMm) const {
    const glm::dvec3 dims(geometry.dims);
    const double edge = blockEdgeVoxels_ << shift_;
    const glm::dvec3 reach = reachOfHalfLayer(geometry, layerLengthMm);
    std::vector<VisibleBox> boxes;
    std::size_t place = 0;
    for (int z = 0; z < size_.z; ++z) {
        for (int y = 0; y < size_.y; ++y) {
            for (int x = 0; x < size_.x; ++x, ++place) {
                if (occupied_[place] == 0) {
                    continue;
                }
                const glm::ivec3 index(x, y, z);
                const glm::dvec3 low = glm::dvec3(index) * edge / dims;
                const glm::dvec3 high =
                    glm::min(glm::dvec3(index + 1) * edge / dims, glm::dvec3(1.0));
                const glm::dvec3 atLow(glm::equal(index, glm::ivec3(0)));
                const glm::dvec3 atHigh(glm::equal(index, size_ - 1));
                boxes.push_back({low - reach * atLow, high + reach * atHigh});
            }
        }
    }
    return boxes;
}

void keepLesser(const std::uint8_t* counts, std::int64_t n, std::uint8_t* __restrict least) {
    for (std::int64_t i = 0; i < n; ++i) {
        least[i] = std::min(least[i], counts[i]);
    }
}

/// The least count at every x in the rows of `edge` times `edge` blocks from `first` on.
void leastOfRows(const FreeLengths& lengths, glm::ivec3 first, int edge,
                 std::vector<std::uint8_t>& least) {
    const glm::ivec3 blocks = lengths.blocks;
    const glm::ivec3 end = glm::min(first + edge, blocks);
    std::fill(least.begin(), least.end(), std::uint8_t(255));
    for (int z = first.z; z < end.z; ++z) {
        for (int y = first.y; y < end.y; ++y) {
            const std::int64_t row = (std::int64_t(z) * blocks.y + y) * blocks.x;
            keepLesser(lengths.counts.data() + row, blocks.x, least.data());
        }
    }
}

} // namespace

std::vector<VisibleBox> visibleBoxes(const FreeLengths& lengths, const VolumeGeometry& geometry,
                                     double layerLengthMm) {
    MacroGrid grid(lengths.blocks, lengths.blockEdgeVoxels);
    const glm::ivec3 cubes = grid.size();
    const std::int64_t rowsOfCubes = std::int64_t(cubes.y) * cubes.z;
    const std::int64_t blocksPerRow = std::int64_t(lengths.blocks.x) << (2 * grid.shift());
    constexpr std::int64_t kGrain = 1 << 18; // blocks that are worth another thread
    const auto markRows = [&](std::int64_t begin, std::int64_t end) {
        std::vector<std::uint8_t> least(lengths.blocks.x);
        for (std::int64_t i = begin; i < end; ++i) {
            const glm::ivec3 first(0, i % cubes.y << grid.shift(), i / cubes.y << grid.shift());
            leastOfRows(lengths, first, 1 << grid.shift(), least);
            std::uint8_t* row = grid.row(first.y, first.z);
            for (int x = 0; x < lengths.blocks.x; ++x) {
                row[x >> grid.shift()] |= least[x] == 0;
            }
        }
    };
    parallelFor(rowsOfCubes, std::max<std::int64_t>(1, kGrain / blocksPerRow), markRows);
    return grid.boxes(geometry, layerLengthMm);
}

std::vector<VisibleBox> visibleBoxes(const Octree& octree, const NodeTest& test,
                                     const VolumeGeometry& geometry, double layerLengthMm) {
    MacroGrid grid(octree.levels.front().nodes, octree.leafEdgeVoxels);
    const int level = std::min(grid.shift(), octree.coarsest());
    for (const glm::ivec3 node : visibleNodes(octree, test, level)) {
        const glm::ivec3 leaf = node << level;
        grid.row(leaf.y, leaf.z)[leaf.x >> grid.shift()] = 1;
    }
    return grid.boxes(geometry, layerLengthMm);
}

} // namespace slabcast

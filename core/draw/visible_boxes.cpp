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
    MacroGrid(glm::ivec3 blocks, int blockEdgeVoxels, std::vector<std::uint8_t>& occupied)
        : blockEdgeVoxels_(blockEdgeVoxels), occupied_(occupied) {
        const auto places = [&] {
            const glm::i64vec3 n(size());
            return n.x * n.y * n.z;
        };
        size_ = blocks;
        while (blockEdgeVoxels << shift_ < kMacroBlockVoxels || places() > kMaxBoxes) {
            size_ = (size_ + 1) / 2;
            ++shift_;
        }
        occupied_.assign(static_cast<std::size_t>(places()), 0);
    }

    int shift() const { return shift_; }
    glm::ivec3 size() const { return size_; }
    /// Flags of the row of cubes that a row of blocks is in.
    std::uint8_t* row(int y, int z) {
        return occupied_.data() + (std::int64_t(z >> shift_) * size_.y + (y >> shift_)) * size_.x;
    }
    void boxes(const VolumeGeometry& geometry, double layerLengthMm,
               std::vector<VisibleBox>& boxes) const;

private:
    int blockEdgeVoxels_;
    int shift_ = 0;
    glm::ivec3 size_{0};
    std::vector<std::uint8_t>& occupied_; // x fastest
};

/// How far half a layer reaches in uvw: the rows of uvwFromModel bound how far a unit length goes
/// along each axis.
glm::dvec3 reachOfHalfLayer(const VolumeGeometry& geometry, double layerLengthMm) {
    const glm::dmat3 rows = glm::transpose(glm::dmat3(geometry.uvwFromModel()));
    return glm::dvec3(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])) *
               (layerLengthMm / 2.0) +
           1e-3 / glm::dvec3(geometry.dims);
}

void MacroGrid::boxes(const VolumeGeometry& geometry, double layerLengthMm,
                      std::vector<VisibleBox>& boxes) const {
    const glm::dvec3 dims(geometry.dims);
    const double edge = blockEdgeVoxels_ << shift_;
    const glm::dvec3 reach = reachOfHalfLayer(geometry, layerLengthMm);
    boxes.clear();
    boxes.reserve(occupied_.size()); // the next TF may show more
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
}

} // namespace

void BoxFinder::find(const FreeLengths& lengths, const VolumeGeometry& geometry,
                     double layerLengthMm) {
    MacroGrid grid(lengths.blocks, lengths.blockEdgeVoxels, occupied_);
    const glm::ivec3 cubes = grid.size();
    const std::int64_t rowsOfCubes = std::int64_t(cubes.y) * cubes.z;
    const std::int64_t blocksPerRow = std::int64_t(lengths.blocks.x) << (2 * grid.shift());
    constexpr std::int64_t kGrain = 1 << 18; // blocks that are worth another thread
    const auto markRows = [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            const glm::ivec3 first(0, i % cubes.y << grid.shift(), i / cubes.y << grid.shift());
            const glm::ivec3 last = glm::min(first + (1 << grid.shift()), lengths.blocks);
            std::uint8_t* row = grid.row(first.y, first.z);
            for (int z = first.z; z < last.z; ++z) {
                for (int y = first.y; y < last.y; ++y) {
                    const std::uint8_t* counts =
                        lengths.counts.data() +
                        (std::int64_t(z) * lengths.blocks.y + y) * lengths.blocks.x;
                    for (int x = 0; x < lengths.blocks.x; ++x) {
                        row[x >> grid.shift()] |= counts[x] == 0;
                    }
                }
            }
        }
    };
    parallelFor(rowsOfCubes, std::max<std::int64_t>(1, kGrain / blocksPerRow), markRows);
    grid.boxes(geometry, layerLengthMm, boxes_);
}

void BoxFinder::find(const Octree& octree, const NodeTest& test, const VolumeGeometry& geometry,
                     double layerLengthMm) {
    MacroGrid grid(octree.levels.front().nodes, octree.leafEdgeVoxels, occupied_);
    const int level = std::min(grid.shift(), octree.coarsest());
    forVisibleNodes(octree, test, level, [&](glm::ivec3 node) {
        const glm::ivec3 leaf = node << level;
        grid.row(leaf.y, leaf.z)[leaf.x >> grid.shift()] = 1;
    });
    grid.boxes(geometry, layerLengthMm, boxes_);
}

std::vector<VisibleBox> visibleBoxes(const FreeLengths& lengths, const VolumeGeometry& geometry,
                                     double layerLengthMm) {
    BoxFinder finder;
    finder.find(lengths, geometry, layerLengthMm);
    return finder.boxes();
}

std::vector<VisibleBox> visibleBoxes(const Octree& octree, const NodeTest& test,
                                     const VolumeGeometry& geometry, double layerLengthMm) {
    BoxFinder finder;
    finder.find(octree, test, geometry, layerLengthMm);
    return finder.boxes();
}

} // namespace slabcast

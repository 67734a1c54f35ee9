#include "core/skip/proximity_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/skip/occupancy.h"

namespace slabcast {

namespace {

// Integers keep the transform exact: in floating point a guard against over-estimates would cost a
// whole quantum wherever a distance is a whole number of quanta, which with cubic voxels is along
// every axis.
constexpr std::int64_t kFar = ProximityUnits::kFar;
constexpr std::uint32_t kFarSquared = ProximityUnits::kFarSquared;

// Spacings and cosines come from text of about six digits: 0.6 / 0.2 is meant as 3, and a cosine of
// 1e-6 as 0. Over 254 quanta this adds 0.003 of the smallest voxel edge, well inside the voxel by
// which occupied blocks were grown.
constexpr double kMeantAs = 1e-5;

std::array<std::int64_t, 3> blockSteps(const VolumeGeometry& geometry, int blockEdgeVoxels) {
    std::array<std::int64_t, 3> steps{};
    for (int axis = 0; axis < 3; ++axis) {
        const double quanta =
            blockEdgeVoxels * geometry.spacingMm[axis] / geometry.smallestVoxelEdgeMm();
        steps[axis] = std::int64_t(std::min(
            double(kFar), std::floor(quanta * (1.0 + kMeantAs) * ProximityUnits::kPerQuantum)));
    }
    return steps;
}

/// Least length in patient space of a unit vector of voxel axes: 1 for orthogonal ones, less for
/// sheared ones. It is the smallest singular value of the cosines, the root of 1 + lambda with
/// lambda the smallest eigenvalue of their products less the identity: a matrix of zero diagonal,
/// whose cubic lambda^3 = p lambda + q has a closed form.
double shortestOfUnitVectors(const glm::dmat3& direction) {
    const double xy = glm::dot(direction[0], direction[1]);
    const double yz = glm::dot(direction[1], direction[2]);
    const double zx = glm::dot(direction[2], direction[0]);
    if (std::max({std::abs(xy), std::abs(yz), std::abs(zx)}) < kMeantAs) {
        return 1.0;
    }
    const double radius = std::sqrt((xy * xy + yz * yz + zx * zx) / 3.0);
    const double cosine = std::clamp(xy * yz * zx / (radius * radius * radius), -1.0, 1.0);
    const double thirdTurn = 2.0943951023931953;
    const double lambda = 2.0 * radius * std::cos(std::acos(cosine) / 3.0 + thirdTurn);
    return std::sqrt(std::max(0.0, 1.0 + lambda - 1e-12)); // what cos and acos may be off by
}

std::int64_t floorDivide(std::int64_t dividend, std::int64_t divisor) {
    return (dividend >= 0 ? dividend : dividend - divisor + 1) / divisor;
}

/// One line of the transform: replaces f by min over j of f(j) + (step * gap)^2, where gap is the
/// number of whole blocks between i and j, max(0, |i - j| - 1). Growing f by one block turns gaps
/// into distances; the minimum is then the lower envelope of one parabola per site, of which each
/// is lowest on one stretch. Source: Felzenszwalb and Huttenlocher 2012, with the integer crossings
/// of Meijster et al. 2000.
class LineTransform {
public:
    LineTransform(int length, std::int64_t step)
        : squaredStep_(step * step), grown_(length), pieces_(length) {}

    void apply(std::uint32_t* line) {
        grow(line);
        layPieces();
        readEnvelope(line);
    }

private:
    struct Piece {
        int site;
        int begin; // first index at which this parabola is the lowest
    };

    void grow(const std::uint32_t* line) {
        const int last = int(grown_.size()) - 1;
        for (int i = 0; i <= last; ++i) {
            grown_[i] = std::min({line[std::max(i - 1, 0)], line[i], line[std::min(i + 1, last)]});
        }
    }

    /// Last index at which the parabola of `left` is not above that of `right`.
    std::int64_t crossing(int left, int right) const {
        const std::int64_t rise = std::int64_t(grown_[right]) - grown_[left];
        return (floorDivide(rise, squaredStep_ * (right - left)) + left + right) >> 1;
    }

    void layPieces() {
        count_ = 0;
        const int length = int(grown_.size());
        for (int site = 0; site < length; ++site) {
            if (grown_[site] == kFarSquared) {
                continue; // bounds nothing
            }
            std::int64_t begin = 0;
            while (count_ > 0) {
                begin = std::max<std::int64_t>(0, crossing(pieces_[count_ - 1].site, site) + 1);
                if (begin > pieces_[count_ - 1].begin) {
                    break;
                }
                --count_;
            }
            if (begin < length) {
                pieces_[count_++] = {site, int(begin)};
            }
        }
    }

    void readEnvelope(std::uint32_t* line) const {
        const int length = int(grown_.size());
        if (count_ == 0) {
            std::fill(line, line + length, kFarSquared);
        }
        for (int p = 0; p < count_; ++p) {
            const auto [site, begin] = pieces_[p];
            const int end = p + 1 < count_ ? pieces_[p + 1].begin : length;
            for (int i = begin; i < end; ++i) {
                const std::int64_t away = i - site;
                line[i] = std::uint32_t(
                    std::min<std::int64_t>(kFarSquared, grown_[site] + squaredStep_ * away * away));
            }
        }
    }

    std::int64_t squaredStep_;
    std::vector<std::uint32_t> grown_;
    std::vector<Piece> pieces_;
    int count_ = 0;
};

/// The lines along one axis of a grid, cut into planes that threads may share: line l of plane p
/// starts at p * planeStride + l * lineStride.
struct AxisLines {
    std::int64_t length, lines;
    std::int64_t stride, lineStride, planeStride;
};

AxisLines linesAlong(int axis, glm::ivec3 size) {
    const std::array<std::int64_t, 3> strides{1, size.x, std::int64_t(size.x) * size.y};
    const int line = axis == 0 ? 1 : 0;
    const int plane = 3 - axis - line;
    return {size[axis], size[line], strides[axis], strides[line], strides[plane]};
}

/// Lines are gathered by the cache line before they are transformed: y and z would else fetch one
/// for each entry.
void transformPlanes(std::uint32_t* squared, const AxisLines& axis, std::int64_t step,
                     std::int64_t firstPlane, std::int64_t endPlane) {
    constexpr std::int64_t kBundle = 16;
    LineTransform transform(int(axis.length), step);
    std::vector<std::uint32_t> bundle(std::size_t(kBundle * axis.length));
    const auto forEntries = [&](std::uint32_t* corner, std::int64_t lines, auto&& visit) {
        for (std::int64_t i = 0; i < axis.length; ++i) {
            for (std::int64_t l = 0; l < lines; ++l) {
                visit(corner[i * axis.stride + l * axis.lineStride],
                      bundle[std::size_t(l * axis.length + i)]);
            }
        }
    };
    for (std::int64_t plane = firstPlane; plane < endPlane; ++plane) {
        for (std::int64_t first = 0; first < axis.lines; first += kBundle) {
            std::uint32_t* corner = squared + plane * axis.planeStride + first * axis.lineStride;
            const std::int64_t lines = std::min(kBundle, axis.lines - first);
            forEntries(corner, lines, [](const auto& grid, auto& local) { local = grid; });
            for (std::int64_t l = 0; l < lines; ++l) {
                transform.apply(bundle.data() + l * axis.length);
            }
            forEntries(corner, lines, [](auto& grid, const auto& local) { grid = local; });
        }
    }
}

/// What stages of the transform hand on.
class SquaredGaps {
public:
    SquaredGaps(ProximityUnits units, glm::ivec3 blocks)
        : units_(units), blocks_(blocks), perSlice_(std::int64_t(blocks.x) * blocks.y),
          squared_(new std::uint32_t[std::size_t(perSlice_ * blocks.z)]) {}

    /// From bytes that are 0 where occupied: gaps along x and y.
    void withinSlices(const std::uint8_t* counts, std::int64_t begin, std::int64_t end) {
        std::transform(counts + begin * perSlice_, counts + end * perSlice_,
                       squared_.get() + begin * perSlice_,
                       [](std::uint8_t count) { return count == 0 ? 0 : kFarSquared; });
        transformPlanes(0, begin, end);
        transformPlanes(1, begin, end);
    }
    /// For a range of rows, all slices.
    void acrossSlices(std::int64_t begin, std::int64_t end) { transformPlanes(2, begin, end); }
    /// Of free blocks one more than the whole quanta of the length.
    void write(std::uint8_t* counts, std::int64_t begin, std::int64_t end) const {
        for (std::int64_t i = begin * perSlice_; i < end * perSlice_; ++i) {
            const int whole = units_.wholeQuanta(squared_[std::size_t(i)]);
            counts[i] = counts[i] == 0 ? 0 : std::uint8_t(1 + whole);
        }
    }

private:
    void transformPlanes(int axis, std::int64_t begin, std::int64_t end) {
        slabcast::transformPlanes(squared_.get(), linesAlong(axis, blocks_),
                                  units_.stepOfBlock[axis], begin, end);
    }

    ProximityUnits units_;
    glm::ivec3 blocks_;
    std::int64_t perSlice_;
    std::unique_ptr<std::uint32_t[]> squared_; // its memory is not touched before its first stage
};

} // namespace

ProximityUnits proximityUnits(const VolumeGeometry& geometry, int blockEdgeVoxels) {
    return {blockSteps(geometry, blockEdgeVoxels),
            shortestOfUnitVectors(geometry.direction) / double(ProximityUnits::kPerQuantum)};
}

BuildStages proximityStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                            const CellVisibility& visibility, const VolumeGeometry& geometry,
                            FreeLengths& result) {
    BuildStages stages =
        occupancyStages(ranges, blockEdgeVoxels, visibility, {.free = 255, .occupied = 0}, result);
    const BuildStages lengths = proximityStages(geometry, result);
    stages.insert(stages.end(), lengths.begin(), lengths.end());
    return stages;
}

BuildStages proximityStages(const VolumeGeometry& geometry, FreeLengths& marked) {
    BuildStages stages;
    marked.quantumMm = geometry.smallestVoxelEdgeMm();
    const auto gaps = std::make_shared<SquaredGaps>(
        proximityUnits(geometry, marked.blockEdgeVoxels), marked.blocks);
    const auto add = [&](std::int64_t items, auto step) {
        stages.push_back({items, [=, &marked](std::int64_t begin, std::int64_t end) {
                              if (marked.occupiedBlocks > 0) { // else all bytes are as they end
                                  step(marked.counts.data(), begin, end);
                              }
                          }});
    };
    add(marked.blocks.z,
        [=](auto* counts, auto begin, auto end) { gaps->withinSlices(counts, begin, end); });
    add(marked.blocks.y, [=](auto*, auto begin, auto end) { gaps->acrossSlices(begin, end); });
    add(marked.blocks.z,
        [=](auto* counts, auto begin, auto end) { gaps->write(counts, begin, end); });
    return stages;
}

Result<FreeLengths> buildProximityCloud(const CellVisibility& visibility,
                                        const VolumeGeometry& geometry, int blockEdgeVoxels,
                                        const CancelToken* cancel) {
    SLABCAST_EXPECTS(geometry.dims == visibility.texels->dims, geometry.dims.x);
    const auto stages = [&](const OctreeLevel& ranges, FreeLengths& result) {
        return proximityStages(ranges, blockEdgeVoxels, visibility, geometry, result);
    };
    return buildGrid(SkipStructure::Proximity, visibility, blockEdgeVoxels, stages, cancel);
}

} // namespace slabcast

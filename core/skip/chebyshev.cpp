#include "core/skip/chebyshev.h"

#include <algorithm>
#include <vector>

#include "core/skip/occupancy.h"

namespace slabcast {

namespace {

constexpr int kFar = 255;

// By value: loops over references to temporaries are not vectorised.
std::uint8_t least(std::uint8_t a, std::uint8_t b) {
    return a < b ? a : b;
}

std::uint8_t addClamped(std::uint8_t distance, int steps) {
    return std::uint8_t(least(distance, std::uint8_t(kFar - steps)) + steps);
}

/// Distances along single rows. Every step doubles how far a site is seen: after steps 1, 2, 4, ...
/// s, all distances below 2s are sums of some of them.
class RowTransform {
public:
    explicit RowTransform(int length)
        : length_(length), from_(length + 2 * kReach, kFar), to_(from_) {}

    void apply(std::uint8_t* row) {
        std::copy(row, row + length_, from_.begin() + kReach);
        for (int step = 1; step <= kReach && step < length_; step *= 2) {
            const std::uint8_t* from = from_.data() + kReach;
            std::uint8_t* __restrict to = to_.data() + kReach;
            for (int x = 0; x < length_; ++x) {
                const std::uint8_t beside = least(from[x - step], from[x + step]);
                to[x] = least(from[x], addClamped(beside, step));
            }
            from_.swap(to_);
        }
        std::copy_n(from_.begin() + kReach, length_, row);
    }

private:
    static constexpr int kReach = 128; // with which the steps come to 255

    int length_;
    std::vector<std::uint8_t> from_; // padded on both sides
    std::vector<std::uint8_t> to_;
};

/// A step from one row, or slice, to the next may go sideways as well. The way to the closest site
/// is then as many steps as it lies away, all to one side, after those inside its own row or slice
/// that are left over: one sweep to either side finds it.
void stepFrom(const std::uint8_t* from, int length, std::uint8_t* __restrict row) {
    const int last = length - 1;
    const std::uint8_t atFirst = least(from[0], from[std::min(1, last)]);
    const std::uint8_t atLast = least(from[last], from[std::max(0, last - 1)]);
    for (int x = 1; x < last; ++x) {
        const std::uint8_t nearest = least(least(from[x - 1], from[x]), from[x + 1]);
        row[x] = least(row[x], addClamped(nearest, 1));
    }
    row[0] = least(row[0], addClamped(atFirst, 1));
    row[last] = least(row[last], addClamped(atLast, 1));
}

/// From one slice to a neighbouring one.
void stepFromSlice(const std::uint8_t* from, glm::ivec2 size, std::vector<std::uint8_t>& scratch,
                   std::uint8_t* slice) {
    const auto row = [&](int y) {
        return from + std::int64_t(std::clamp(y, 0, size.y - 1)) * size.x;
    };
    for (int y = 0; y < size.y; ++y) {
        const std::uint8_t* rows[] = {row(y - 1), row(y), row(y + 1)};
        std::uint8_t* __restrict nearest = scratch.data();
        for (int x = 0; x < size.x; ++x) {
            nearest[x] = least(least(rows[0][x], rows[1][x]), rows[2][x]);
        }
        stepFrom(nearest, size.x, slice + std::int64_t(y) * size.x);
    }
}

} // namespace

void ChebyshevTransform::withinSlices(std::int64_t begin, std::int64_t end) const {
    RowTransform rowTransform(size.x);
    for (std::int64_t z = begin; z < end; ++z) {
        const auto row = [&](int y) { return bytes + (z * size.y + y) * size.x; };
        rowTransform.apply(row(0));
        for (int y = 1; y < size.y; ++y) {
            rowTransform.apply(row(y));
            stepFrom(row(y - 1), size.x, row(y));
        }
        for (int y = size.y - 2; y >= 0; --y) {
            stepFrom(row(y + 1), size.x, row(y));
        }
    }
}

void ChebyshevTransform::upwards(std::int64_t begin, std::int64_t end) const {
    const std::int64_t perSlice = std::int64_t(size.x) * size.y;
    std::vector<std::uint8_t> scratch(size.x);
    for (std::int64_t z = std::max<std::int64_t>(begin, 1); z < end; ++z) {
        std::uint8_t* slice = bytes + z * perSlice;
        stepFromSlice(slice - perSlice, size, scratch, slice);
    }
}

void ChebyshevTransform::downwards(std::int64_t begin, std::int64_t end) const {
    const std::int64_t perSlice = std::int64_t(size.x) * size.y;
    std::vector<std::uint8_t> scratch(size.x);
    for (std::int64_t i = std::max<std::int64_t>(begin, 1); i < end; ++i) {
        std::uint8_t* slice = bytes + (size.z - 1 - i) * perSlice;
        stepFromSlice(slice + perSlice, size, scratch, slice);
    }
}

BuildStages chebyshevStages(const OctreeLevel& ranges, int blockEdgeVoxels,
                            const CellVisibility& visibility, FreeLengths& result) {
    BuildStages stages =
        occupancyStages(ranges, blockEdgeVoxels, visibility, {.free = kFar, .occupied = 0}, result);
    const BuildStages distances = chebyshevStages(result);
    stages.insert(stages.end(), distances.begin(), distances.end());
    return stages;
}

BuildStages chebyshevStages(FreeLengths& marked) {
    const auto transform = [&marked] { // when there is room
        return ChebyshevTransform{marked.blocks, marked.counts.data()};
    };
    const std::int64_t slices = marked.blocks.z;
    return {{slices, [=](auto begin, auto end) { transform().withinSlices(begin, end); }},
            {slices, [=](auto begin, auto end) { transform().upwards(begin, end); }, true},
            {slices, [=](auto begin, auto end) { transform().downwards(begin, end); }, true}};
}

Result<FreeLengths> buildChebyshev(const CellVisibility& visibility, int blockEdgeVoxels,
                                   const CancelToken* cancel) {
    const auto stages = [&](const OctreeLevel& ranges, FreeLengths& result) {
        return chebyshevStages(ranges, blockEdgeVoxels, visibility, result);
    };
    return buildGrid(SkipStructure::Chebyshev, visibility, blockEdgeVoxels, stages, cancel);
}

} // namespace slabcast

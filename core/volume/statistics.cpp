#include "core/volume/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/parallel.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

constexpr std::int64_t kGrain = 1 << 18;
constexpr double kAirHu = -900.0;
constexpr double kWaterHu = 0.0;

/// Of one run of stored voxels.
struct Extent {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();
    double sum = 0.0;
};

/// About the mean and over the range that the first pass found.
struct Spread {
    double squares = 0.0;
    std::array<std::int64_t, 256> histogram{};
};

/// One partial result per run of voxels, in their order: sums do not depend on the threads.
template <class Partial, class T, class Body>
std::vector<Partial> reduceRuns(std::span<const T> voxels, const Body& body) {
    const auto count = static_cast<std::int64_t>(voxels.size());
    std::vector<Partial> partials(static_cast<std::size_t>((count + kGrain - 1) / kGrain));
    parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
        partials[static_cast<std::size_t>(begin / kGrain)] = body(
            voxels.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
    });
    return partials;
}

template <class T>
Extent extentOf(std::span<const T> voxels) {
    Extent extent;
    for (const Extent& part : reduceRuns<Extent>(voxels, [](std::span<const T> run) {
             const auto [min, max] = std::minmax_element(run.begin(), run.end());
             Extent result{static_cast<double>(*min), static_cast<double>(*max), 0.0};
             for (const T voxel : run) {
                 result.sum += static_cast<double>(voxel);
             }
             return result;
         })) {
        extent.min = std::min(extent.min, part.min);
        extent.max = std::max(extent.max, part.max);
        extent.sum += part.sum;
    }
    return extent;
}

template <class T>
Spread spreadOf(std::span<const T> voxels, double mean, double origin, double binsPerStep) {
    Spread spread;
    for (const Spread& part : reduceRuns<Spread>(voxels, [=](std::span<const T> run) {
             Spread result;
             for (const T voxel : run) {
                 const auto value = static_cast<double>(voxel);
                 const double bin = std::clamp((value - origin) * binsPerStep, 0.0, 255.0);
                 result.squares += (value - mean) * (value - mean);
                 ++result.histogram[static_cast<std::size_t>(bin)];
             }
             return result;
         })) {
        spread.squares += part.squares;
        std::transform(spread.histogram.begin(), spread.histogram.end(), part.histogram.begin(),
                       spread.histogram.begin(), std::plus<>());
    }
    return spread;
}

template <class T>
VolumeStatistics statisticsOf(std::span<const T> voxels, double slope, double intercept) {
    const Extent extent = extentOf(voxels);
    const auto count = static_cast<double>(voxels.size());
    const double mean = extent.sum / count;
    const double range = extent.max - extent.min;
    // Bins run along the data values, so a negative slope counts from the largest voxel downwards.
    const double origin = slope > 0.0 ? extent.min : extent.max;
    const double bins = 256.0 / range; // infinite where the range is nothing, or next to nothing
    const double binsPerStep = std::isfinite(bins) ? std::copysign(bins, slope) : 0.0;
    const Spread spread = spreadOf(voxels, mean, origin, binsPerStep);
    const double a = slope * extent.min + intercept;
    const double b = slope * extent.max + intercept;
    return {std::min(a, b), std::max(a, b), slope * mean + intercept,
            std::abs(slope) * std::sqrt(spread.squares / count), spread.histogram};
}

} // namespace

VolumeStatistics computeStatistics(const Volume& volume) {
    SLABCAST_EXPECTS(!volume.voxels.empty(), volume.voxels.size());
    return visitVoxels(volume, [&](auto voxels) {
        return statisticsOf(voxels, volume.rescaleSlope, volume.rescaleIntercept);
    });
}

Modality likelyModality(const Volume& volume, const VolumeStatistics& statistics) {
    if (volume.modality != Modality::Unknown) {
        return volume.modality;
    }
    const bool airToBeyondWater = statistics.min <= kAirHu && statistics.max > kWaterHu;
    return airToBeyondWater ? Modality::Ct : Modality::Unknown;
}

} // namespace slabcast

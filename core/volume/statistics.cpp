#include "core/volume/statistics.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/bits.h"
#include "core/base/parallel.h"
#include "core/volume/counted_values.h"
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
    double aboveMin = 0.0; // the least value but for the minimum; the maximum where there is none
    double belowMax = 0.0;
};

/// Of the bulk, in stored voxels.
struct Cut {
    double low = 0.0;
    double high = 0.0;
};

constexpr double kFarInSpans = 4.0;           // an end value that is so far off stands alone
constexpr double kShareOfOutliers = 0.0005;   // at either end
constexpr std::int64_t kFewOutliers = 8;      // at either end of a small volume
constexpr std::int64_t kVoxelsPerFew = 512;   // but no more than one of so many
constexpr double kNarrow = 1.0 / 8.0;         // of the range: what lies within is hardly seen
constexpr std::int64_t kFewestDistinct = 8;   // values: fewer are labels, each of which counts
constexpr std::int64_t kVoxelsPerFill = 1000; // one of so many is no stray voxel any more
constexpr std::size_t kPrefixes = 1 << 16;

/// One partial result per run of voxels, in their order: sums do not depend on the threads.
template <class Partial, class V, class Body>
std::vector<Partial> reduceRuns(std::span<const V> voxels, const Body& body) {
    const auto count = static_cast<std::int64_t>(voxels.size());
    std::vector<Partial> partials(static_cast<std::size_t>((count + kGrain - 1) / kGrain));
    parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
        partials[static_cast<std::size_t>(begin / kGrain)] = body(
            voxels.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
    });
    return partials;
}

template <class V>
Extent extentOf(std::span<const V> voxels) {
    Extent extent;
    for (const Extent& part : reduceRuns<Extent>(voxels, [](std::span<const V> run) {
             auto min = valueOf(run.front());
             auto max = min;
             for (const V& voxel : run) {
                 min = std::min(min, valueOf(voxel));
                 max = std::max(max, valueOf(voxel));
             }
             Extent result{static_cast<double>(min), static_cast<double>(max), 0.0};
             for (const V& voxel : run) {
                 result.sum += dataOf(voxel) * static_cast<double>(countOf(voxel));
             }
             return result;
         })) {
        extent.min = std::min(extent.min, part.min);
        extent.max = std::max(extent.max, part.max);
        extent.sum += part.sum;
    }
    return extent;
}

template <class V>
Spread spreadOf(std::span<const V> voxels, const Extent& extent, double mean, double origin,
                double binsPerStep) {
    using T = decltype(valueOf(voxels.front()));
    const T min = static_cast<T>(extent.min);
    const T max = static_cast<T>(extent.max);
    Spread spread;
    spread.aboveMin = extent.max;
    spread.belowMax = extent.min;
    for (const Spread& part : reduceRuns<Spread>(voxels, [=](std::span<const V> run) {
             Spread result;
             T aboveMin = max;
             T belowMax = min;
             for (const V& voxel : run) {
                 aboveMin = std::min(aboveMin, valueOf(voxel) > min ? valueOf(voxel) : max);
                 belowMax = std::max(belowMax, valueOf(voxel) < max ? valueOf(voxel) : min);
             }
             result.aboveMin = static_cast<double>(aboveMin);
             result.belowMax = static_cast<double>(belowMax);
             for (const V& voxel : run) {
                 const double value = dataOf(voxel);
                 const double bin = std::clamp((value - origin) * binsPerStep, 0.0, 255.0);
                 result.squares +=
                     (value - mean) * (value - mean) * static_cast<double>(countOf(voxel));
                 result.histogram[static_cast<std::size_t>(bin)] += countOf(voxel);
             }
             return result;
         })) {
        spread.squares += part.squares;
        spread.aboveMin = std::min(spread.aboveMin, part.aboveMin);
        spread.belowMax = std::max(spread.belowMax, part.belowMax);
        std::transform(spread.histogram.begin(), spread.histogram.end(), part.histogram.begin(),
                       spread.histogram.begin(), std::plus<>());
    }
    return spread;
}

/// Without an end value that is far from all others; one that is farther still may hide another.
Cut withoutFarEnds(const Extent& extent, const Spread& spread) {
    Cut cut{extent.min, extent.max};
    for (int round = 0; round < 2; ++round) {
        const double below = spread.belowMax - cut.low;
        if (below > 0.0 && extent.max - spread.belowMax > kFarInSpans * below) {
            cut.high = spread.belowMax;
        }
        const double above = cut.high - spread.aboveMin;
        if (above > 0.0 && spread.aboveMin - extent.min > kFarInSpans * above) {
            cut.low = spread.aboveMin;
        }
    }
    return cut;
}

std::int64_t mostOutliers(std::int64_t count) {
    const auto share = static_cast<std::int64_t>(kShareOfOutliers * static_cast<double>(count));
    return std::max(share, std::min(kFewOutliers, count / kVoxelsPerFew));
}

/// First and last of the places that hold all but `outliers` of either end.
template <class Counts>
std::pair<std::size_t, std::size_t> inner(const Counts& counts, std::int64_t outliers) {
    std::size_t first = 0;
    std::size_t last = counts.size() - 1;
    for (std::int64_t below = counts[first]; first < last && below <= outliers;) {
        below += counts[++first];
    }
    for (std::int64_t above = counts[last]; last > first && above <= outliers;) {
        above += counts[--last];
    }
    return {first, last};
}

/// Of the order of float32: sign, exponent and 7 bits more.
template <class T>
std::size_t prefixOf(T voxel) {
    const auto bits = bitsAs<std::uint32_t>(static_cast<float>(voxel));
    return (bits >> 31 != 0 ? ~bits : bits | 0x80000000U) >> 16;
}

/// The values of a cut without the outliers of either end, as a cut that ends at values.
template <class V>
Cut withoutOutliers(std::span<const V> voxels, Cut cut, std::int64_t outliers) {
    const auto within = [cut](const V& voxel) {
        const double value = dataOf(voxel);
        return value >= cut.low && value <= cut.high;
    };
    std::vector<std::atomic<std::int64_t>> counts(kPrefixes);
    const auto count = static_cast<std::int64_t>(voxels.size());
    parallelFor(count, 4 * kGrain, [&](std::int64_t begin, std::int64_t end) {
        std::vector<std::int64_t> own(kPrefixes);
        for (std::int64_t i = begin; i < end; ++i) {
            const V& voxel = voxels[static_cast<std::size_t>(i)];
            own[prefixOf(valueOf(voxel))] += within(voxel) ? countOf(voxel) : 0;
        }
        for (std::size_t k = 0; k < kPrefixes; ++k) {
            if (own[k] != 0) {
                counts[k].fetch_add(own[k], std::memory_order_relaxed);
            }
        }
    });
    const auto [first, last] = inner(counts, outliers);
    Cut inside{cut.high, cut.low};
    for (const Cut& part :
         reduceRuns<Cut>(voxels, [=, f = first, l = last](std::span<const V> run) {
             Cut result{cut.high, cut.low};
             for (const V& voxel : run) {
                 const std::size_t prefix = prefixOf(valueOf(voxel));
                 if (prefix >= f && prefix <= l && within(voxel)) {
                     result.low = std::min(result.low, dataOf(voxel));
                     result.high = std::max(result.high, dataOf(voxel));
                 }
             }
             return result;
         })) {
        inside.low = std::min(inside.low, part.low);
        inside.high = std::max(inside.high, part.high);
    }
    return inside;
}

/// What lies in, below and above a cut.
struct Sides {
    std::array<bool, 256> taken{}; // of even parts of the cut
    std::int64_t below = 0;
    std::int64_t above = 0;
};

template <class V>
Sides sidesOf(std::span<const V> voxels, Cut cut) {
    Sides sides;
    for (const Sides& part : reduceRuns<Sides>(voxels, [=](std::span<const V> run) {
             Sides result;
             for (const V& voxel : run) {
                 const double value = dataOf(voxel);
                 result.below += value < cut.low ? countOf(voxel) : 0;
                 result.above += value > cut.high ? countOf(voxel) : 0;
                 if (value >= cut.low && value <= cut.high) {
                     const double place = 255.0 * ((value - cut.low) / (cut.high - cut.low));
                     result.taken[static_cast<std::size_t>(place)] = true;
                 }
             }
             return result;
         })) {
        sides.below += part.below;
        sides.above += part.above;
        for (std::size_t k = 0; k < sides.taken.size(); ++k) {
            sides.taken[k] = sides.taken[k] || part.taken[k];
        }
    }
    return sides;
}

/// In stored voxels.
template <class V>
std::optional<BulkOfValues> bulkOf(std::span<const V> voxels, std::int64_t count,
                                   const Extent& extent, const Spread& spread) {
    const Cut near = withoutFarEnds(extent, spread);
    const bool farBelow = near.low > extent.min;
    const bool farAbove = near.high < extent.max;
    const auto [first, last] = inner(spread.histogram, mostOutliers(count));
    const bool wide = static_cast<double>(last) - static_cast<double>(first) - 1.0 >=
                      kNarrow * static_cast<double>(spread.histogram.size());
    if (!farBelow && !farAbove && (wide || extent.min == extent.max)) {
        return std::nullopt;
    }
    const Cut inside = withoutOutliers(voxels, near, mostOutliers(count));
    const double span = inside.high - inside.low;
    const bool narrow = span > 0.0 && span < kNarrow * (near.high - near.low);
    if (!farBelow && !farAbove && !narrow) {
        return std::nullopt;
    }
    const Cut cut = narrow ? inside : near;
    const Sides sides = sidesOf(voxels, cut);
    if (std::count(sides.taken.begin(), sides.taken.end(), true) < kFewestDistinct) {
        return std::nullopt;
    }
    const auto isFill = [count](std::int64_t outside) { return outside >= count / kVoxelsPerFill; };
    return BulkOfValues{.range = {cut.low, cut.high},
                        .voxelsBelow = sides.below,
                        .voxelsAbove = sides.above,
                        .fillBelow = farBelow && cut.low == near.low && isFill(sides.below),
                        .fillAbove = farAbove && cut.high == near.high && isFill(sides.above)};
}

/// Rescaled.
BulkOfValues inData(BulkOfValues bulk, double slope, double intercept) {
    bulk.range.min = slope * bulk.range.min + intercept;
    bulk.range.max = slope * bulk.range.max + intercept;
    if (slope < 0.0) {
        std::swap(bulk.range.min, bulk.range.max);
        std::swap(bulk.voxelsBelow, bulk.voxelsAbove);
        std::swap(bulk.fillBelow, bulk.fillAbove);
    }
    return bulk;
}

/// Of a volume of `all` voxels.
template <class V>
VolumeStatistics statisticsOf(std::span<const V> voxels, std::int64_t all, double slope,
                              double intercept) {
    const Extent extent = extentOf(voxels);
    const auto count = static_cast<double>(all);
    const double mean = extent.sum / count;
    const double range = extent.max - extent.min;
    // Bins run along the data values, so a negative slope counts from the largest voxel downwards.
    const double origin = slope > 0.0 ? extent.min : extent.max;
    const double bins = 256.0 / range; // infinite where the range is nothing, or next to nothing
    const double binsPerStep = std::isfinite(bins) ? std::copysign(bins, slope) : 0.0;
    const Spread spread = spreadOf(voxels, extent, mean, origin, binsPerStep);
    const double a = slope * extent.min + intercept;
    const double b = slope * extent.max + intercept;
    std::optional<BulkOfValues> bulk = bulkOf(voxels, all, extent, spread);
    if (bulk) {
        bulk = inData(*bulk, slope, intercept);
    }
    return {std::min(a, b),           std::max(a, b),
            slope * mean + intercept, std::abs(slope) * std::sqrt(spread.squares / count),
            spread.histogram,         bulk};
}

/// Of fewer voxels, a table of 16 bits costs more than it saves.
constexpr std::size_t kFewestCounted = std::size_t{1} << 18;

} // namespace

VolumeStatistics computeStatistics(const Volume& volume) {
    SLABCAST_EXPECTS(!volume.voxels.empty(), volume.voxels.size());
    return visitVoxels(volume, [&]<class T>(std::span<const T> voxels) {
        const auto all = static_cast<std::int64_t>(voxels.size());
        const auto from = [&]<class V>(std::span<const V> values) {
            return statisticsOf(values, all, volume.rescaleSlope, volume.rescaleIntercept);
        };
        if constexpr (std::is_integral_v<T> && sizeof(T) <= 2) {
            if (sizeof(T) == 1 || voxels.size() >= kFewestCounted) {
                const std::vector<Counted<T>> values = countedValues(voxels);
                return from(std::span<const Counted<T>>(values));
            }
        }
        return from(voxels);
    });
}

Modality likelyModality(const Volume& volume, const VolumeStatistics& statistics) {
    if (volume.modality != Modality::Unknown) {
        return volume.modality;
    }
    const ValueRange range = statistics.shown();
    const bool airToBeyondWater = range.min <= kAirHu && range.max > kWaterHu;
    return airToBeyondWater ? Modality::Ct : Modality::Unknown;
}

} // namespace slabcast

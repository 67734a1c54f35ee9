#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <type_traits>
#include <vector>

#include "core/base/parallel.h"

namespace slabcast {

/// A value that so many voxels have, in a list where each value comes once.
template <class T>
struct Counted {
    T value;
    std::int64_t count;
};

// What follows reads voxels one by one, or counted values: of 8 and 16 bits these say all.
template <class T>
T valueOf(T voxel) {
    return voxel;
}
template <class T>
T valueOf(const Counted<T>& counted) {
    return counted.value;
}
template <class T>
std::int64_t countOf(T /*voxel*/) {
    return 1;
}
template <class T>
std::int64_t countOf(const Counted<T>& counted) {
    return counted.count;
}
template <class V>
double dataOf(const V& voxel) {
    return static_cast<double>(valueOf(voxel));
}

/// Each value that is there, in order, from one pass over the voxels.
template <class T>
std::vector<Counted<T>> countedValues(std::span<const T> voxels) {
    constexpr std::size_t kValues = std::size_t{1} << 8 * sizeof(T);
    constexpr std::size_t kTables = sizeof(T) == 1 ? 4 : 1; // equal neighbours do not wait
    constexpr std::int64_t kVoxelsAtOnce = std::int64_t{1} << 22;
    using Bits = std::make_unsigned_t<T>;
    std::vector<std::int64_t> counts(kValues);
    std::mutex mutex;
    parallelFor(static_cast<std::int64_t>(voxels.size()), kVoxelsAtOnce,
                [&](std::int64_t begin, std::int64_t end) {
                    std::vector<std::uint32_t> own(kValues * kTables);
                    for (std::int64_t i = begin; i < end; ++i) {
                        const auto value = static_cast<Bits>(voxels[static_cast<std::size_t>(i)]);
                        const auto table = static_cast<std::size_t>(i) % kTables;
                        ++own[table * kValues + value];
                    }
                    const std::lock_guard lock(mutex);
                    for (std::size_t k = 0; k < own.size(); ++k) {
                        counts[k % kValues] += own[k];
                    }
                });
    std::vector<Counted<T>> values;
    for (std::int64_t value = std::numeric_limits<T>::min(); value <= std::numeric_limits<T>::max();
         ++value) {
        const std::int64_t count = counts[static_cast<Bits>(value)];
        if (count > 0) {
            values.push_back({static_cast<T>(value), count});
        }
    }
    return values;
}

} // namespace slabcast

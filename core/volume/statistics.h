#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/volume/volume.h"

namespace slabcast {

struct ValueRange {
    double min = 0.0;
    double max = 0.0;
};

/// Where nearly all voxels lie, in data values: both ends are values of voxels.
struct BulkOfValues {
    ValueRange range;
    std::int64_t voxelsBelow = 0;
    std::int64_t voxelsAbove = 0;
    /// Those below, or above, hold one and the same value and are 0.1 % of all or more: most likely
    /// it stands for no value.
    bool fillBelow = false;
    bool fillAbove = false;
};

/// Of the data values (rescaled). The histogram's 256 bins divide [min, max] evenly.
struct VolumeStatistics {
    double min = 0.0;
    double max = 0.0;
    double mean = 0.0;
    double standardDeviation = 0.0;
    std::array<std::int64_t, 256> histogram{};
    /// There only where outliers make [min, max] say little of the data: the least or greatest
    /// value is farther from the next one than 4 times the span of all others, or the values
    /// without 0.05 % of the voxels at either end (to within 1/128 of a value; in small volumes 8
    /// voxels, or one in 512) span less than 1/8 of the range. Never of data that are few values.
    std::optional<BulkOfValues> bulk;

    /// What a transfer function is laid over where it has no values of its own: the bulk where
    /// there is one, else [min, max].
    ValueRange shown() const { return bulk ? bulk->range : ValueRange{min, max}; }
};

/// Cost: one pass over voxels of 8 or 16 bits, two over others, all cores; three more of these
/// where outliers are likely. The same on
/// any number of threads. Tested by: volume_test.cpp, bulk_test.cpp
VolumeStatistics computeStatistics(const Volume& volume);

/// As the file says. Where it says nothing: CT if the data, without outliers, reach from air (-900
/// or below) to beyond water (0), else unknown.
Modality likelyModality(const Volume& volume, const VolumeStatistics& statistics);

} // namespace slabcast

#pragma once

#include <array>
#include <cstdint>

#include "core/volume/volume.h"

namespace slabcast {

/// Of the data values (rescaled). The histogram's 256 bins divide [min, max] evenly.
struct VolumeStatistics {
    double min = 0.0;
    double max = 0.0;
    double mean = 0.0;
    double standardDeviation = 0.0;
    std::array<std::int64_t, 256> histogram{};
};

/// Cost: two passes over the voxels, all cores. Tested by: volume_test.cpp
VolumeStatistics computeStatistics(const Volume& volume);

/// As the file says. Where it says nothing: CT if the data reach from air (-900 or below) to beyond
/// water (0), else unknown.
Modality likelyModality(const Volume& volume, const VolumeStatistics& statistics);

} // namespace slabcast

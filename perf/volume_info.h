#pragma once

#include <cstdint>
#include <string>

#include "core/scene/memory_forecast.h"
#include "core/volume/statistics.h"
#include "core/volume/volume.h"

namespace slabcast {

/// What is known of a volume after its voxels are gone.
struct VolumeInfo {
    std::string name;
    VoxelType type = VoxelType::U8;
    std::string unit;
    glm::ivec3 dims{0};
    glm::dvec3 spacingMm{0.0};
    std::int64_t bytes = 0;
    Modality modality = Modality::Unknown;
    std::string formatReason; // why its texels are of their format
    MemoryForecast forecast;
};

} // namespace slabcast

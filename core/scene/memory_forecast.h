#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "core/gl/caps.h"
#include "core/plan/needs.h"
#include "core/volume/texels.h"

namespace slabcast {

/// What showing a volume takes, before anything is allocated.
struct MemoryForecast {
    std::int64_t gpuTexelBytes = 0;  // with normals
    std::int64_t hostVoxelBytes = 0; // the volume as loaded
    std::int64_t hostTexelBytes = 0; // what is uploaded, or classified first; 0: as the voxels
    std::int64_t hostClassifiedBytes = 0;
    std::int64_t hostNormalsBytes = 0;
    std::int64_t hostCodeBytes = 0; // codes that the skip structures are built from
    std::int64_t hostBytes() const {
        return hostVoxelBytes + hostTexelBytes + hostClassifiedBytes + hostNormalsBytes +
               hostCodeBytes;
    }
};

/// Bytes per voxel of the textures that are drawn from: the scalars' or the pre-classified
/// colours', and baked normals'.
std::int64_t uploadedBytesPerVoxel(TexelFormat format, const Needs& needs);

/// Fails: EmptyVolume, SizeOverflow. Tested by: texel_format_gl_test.cpp
Result<MemoryForecast> forecastMemory(glm::ivec3 dims, VoxelType type, TexelFormat format,
                                      const Needs& needs = {});

/// Fails: EmptyVolume, SizeOverflow.
Result<std::int64_t> forecastTextureBytes(glm::ivec3 dims, TexelFormat format);

/// Whether the texture stays within the device's 3D texture limit and the budget, if there is one.
/// Fails: VolumeTooLarge, naming the limit and the smallest `--downsample N` that fits;
/// EmptyVolume, SizeOverflow.
Result<void> checkFits(glm::ivec3 dims, std::int64_t bytesPerTexel, const gl::Caps& caps,
                       std::optional<std::int64_t> gpuBudgetBytes = std::nullopt);

/// Whether the driver has room for such a texture, which no query tells: makes one and lets it go.
/// Below 256 MiB it is believed to. Cost: as much as making a texture without content; some drivers
/// fill it with zeros. Changes the binding of the active unit. Fails: DeviceOutOfMemory, Internal.
/// Contract: checkFits(); bytes per texel of 1, 2 or 4.
Result<void> checkRoom(glm::ivec3 dims, std::int64_t bytesPerTexel);

} // namespace slabcast

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "core/gl/caps.h"
#include "core/gl/objects.h"
#include "core/volume/texels.h"

namespace slabcast {

/// What showing a volume takes, before anything is allocated.
struct MemoryForecast {
    std::int64_t gpuTexelBytes = 0;
    std::int64_t hostVoxelBytes = 0; // the volume as loaded
    std::int64_t hostTexelBytes = 0; // what is uploaded, or classified first
    std::int64_t hostClassifiedBytes = 0;
    std::int64_t hostCodeBytes = 0; // codes that the skip structures are built from
    std::int64_t hostBytes() const {
        return hostVoxelBytes + hostTexelBytes + hostClassifiedBytes + hostCodeBytes;
    }
};

/// Bytes per texel of the texture that is drawn from: the scalars' or, `preclassified`, the
/// colours'.
std::int64_t uploadedBytesPerTexel(TexelFormat format, bool preclassified);

/// Fails: EmptyVolume, SizeOverflow. Tested by: texel_format_gl_test.cpp
Result<MemoryForecast> forecastMemory(glm::ivec3 dims, VoxelType type, TexelFormat format,
                                      bool preclassified = false);

/// Fails: EmptyVolume, SizeOverflow.
Result<std::int64_t> forecastTextureBytes(glm::ivec3 dims, TexelFormat format);

/// Whether the texture stays within the device's 3D texture limit and the budget, if there is one.
/// Fails: VolumeTooLarge, naming the limit and the smallest `--downsample N` that fits;
/// EmptyVolume, SizeOverflow.
Result<void> checkFits(glm::ivec3 dims, std::int64_t bytesPerTexel, const gl::Caps& caps,
                       std::optional<std::int64_t> gpuBudgetBytes = std::nullopt);

/// The uploads below leave the GL state as they found it, go slab by slab, clamp to the edge and
/// have one level. To know their own errors they lower every error flag that was up before: a host
/// that wants to hear of its own calls glGetError first. Fail: VolumeTooLarge, DeviceOutOfMemory,
/// Internal (another GL error). Tested by: texel_format_gl_test.cpp

/// How texels lie in a texture and in memory.
struct TexelLayout {
    GLenum internalFormat;
    GLenum format;
    GLenum type;
    GLint filter;
    std::int64_t bytesPerTexel;
};

/// A 3D texture, bound and without content. Contract: it is within the device's limit.
Result<gl::Texture> allocate3d(const char* label, const TexelLayout& layout, glm::ivec3 dims);

/// Whole slices of a 3D texture.
struct Slices {
    glm::ivec3 dims{0};
    int first = 0;
};

/// Puts `texels`, tightly packed, into slices of a texture of this layout.
Result<void> fillSlices(const char* label, const gl::Texture& texture, const TexelLayout& layout,
                        const Slices& slices, const void* texels);

/// Both.
Result<gl::Texture> upload3d(const char* label, const TexelLayout& layout, glm::ivec3 dims,
                             const void* texels);

/// A 2D texture of one level.
Result<gl::Texture> upload2d(const char* label, const TexelLayout& layout, glm::ivec2 size,
                             const void* texels);

/// What the last uploads raised. Fails: DeviceOutOfMemory, Internal.
Result<void> takeUploadError(const std::string& what);

/// Scalars: R8, R16 and R16F filtered; Rg8Exact (r high byte, g low byte) and R32fExact for
/// texelFetch.
Result<gl::Texture> uploadTexels(const Texels& texels, const gl::Caps& caps);

/// Pre-classified texels, RGBA8, filtered. `texels` holds dims.x * dims.y * dims.z, x fastest.
Result<gl::Texture> uploadClassified(const glm::u8vec4* texels, glm::ivec3 dims,
                                     const gl::Caps& caps);

/// A transfer table: RGBA16F, or RGBA32F where `wide`; width x 1, for texelFetch on a sampler2D.
Result<gl::Texture> uploadTable(const std::vector<glm::vec4>& texels, bool wide,
                                const gl::Caps& caps);

/// A pre-integrated table: RGBA16F, as wide as high, filtered.
Result<gl::Texture> uploadSquareTable(const std::vector<glm::u16vec4>& halfs, const gl::Caps& caps);

} // namespace slabcast

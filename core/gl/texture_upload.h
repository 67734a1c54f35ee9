#pragma once

#include <cstdint>
#include <string>

#include <glm/glm.hpp>

#include "core/gl/objects.h"

namespace slabcast {

/// The uploads below leave the GL state as they found it, go slab by slab, clamp to the edge and
/// have one level. To know their own errors they lower every error flag that was up before: a host
/// that wants to hear of its own calls glGetError first. Fail: DeviceOutOfMemory, Internal (another
/// GL error). Tested by: texel_format_gl_test.cpp

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

} // namespace slabcast

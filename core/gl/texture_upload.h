#pragma once

#include <cstdint>
#include <string>

#include <glm/glm.hpp>

#include "core/gl/objects.h"

namespace slabcast {

/// The uploads below bind their textures to the active unit and make unpacking plain; who calls
/// them holds a gl::StateScope where that is the host's. The textures have one level and clamp to
/// the edge; 3D texels are uploaded in parts of 16 MiB, which bounds the driver's staging memory.
/// GL errors that were raised before and not read are lost: a host that wants to know of its own
/// must call glGetError before. Fail: DeviceOutOfMemory, Internal (another GL error). Tested by:
/// texel_format_gl_test.cpp

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

/// Uploads `texels`, tightly packed, to slices of a texture that was allocated with this layout.
Result<void> fillSlices(const char* label, const gl::Texture& texture, const TexelLayout& layout,
                        const Slices& slices, const void* texels);

/// allocate3d() and fillSlices() in one.
Result<gl::Texture> upload3d(const char* label, const TexelLayout& layout, glm::ivec3 dims,
                             const void* texels);

/// A 2D texture of one level, without content, and with some.
Result<gl::Texture> allocate2d(const char* label, const TexelLayout& layout, glm::ivec2 size);
Result<gl::Texture> upload2d(const char* label, const TexelLayout& layout, glm::ivec2 size,
                             const void* texels);

/// Uploads `texels`, tightly packed, to the lower left part of a 2D texture of this layout. Asks GL
/// nothing and allocates nothing. Contract: they fit.
void fill2d(const gl::Texture& texture, const TexelLayout& layout, glm::ivec2 size,
            const void* texels);

/// Reads the GL error flags; `what` names the upload in the error. Fails: DeviceOutOfMemory,
/// Internal.
Result<void> takeUploadError(const std::string& what);

} // namespace slabcast

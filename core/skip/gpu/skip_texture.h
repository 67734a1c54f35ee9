#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "core/gl/caps.h"
#include "core/gl/objects.h"
#include "core/gl/texture_upload.h"
#include "core/skip/skip_layout.h"

namespace slabcast {

/// A skip structure as shaders fetch it: one 3D texture, unfiltered.
struct SkipTexture {
    gl::Texture texture;
    std::int64_t bytes = 0;
};

/// R32UI up to 32 bits; RGBA16UI for 64, the lowest 16 bits in r; RGBA32UI for 128.
const TexelLayout& texelLayoutOf(const SkipLayout& layout);

/// Fails: VolumeTooLarge, where the device's 3D textures are too small, or texels more than shaders
/// count, naming the limit. Tested by: skip_texture_test.cpp
Result<void> checkFits(const SkipLayout& layout, const gl::Caps& caps);

/// A texture of that layout, without content. Fails: VolumeTooLarge, DeviceOutOfMemory.
Result<SkipTexture> allocateSkip(const char* label, const SkipLayout& layout, const gl::Caps& caps);

/// Like the uploads of core/gl/texture_upload.h. Fail:
/// VolumeTooLarge, DeviceOutOfMemory, Internal (another GL error). Tested by:
/// gpu_builder_gl_test.cpp
Result<SkipTexture> uploadFreeLengths(const FreeLengths& lengths, const gl::Caps& caps);
Result<SkipTexture> uploadOctree(const Octree& octree, const gl::Caps& caps);

/// The texture of a grid of that many blocks, without content; and slices [begin, end) of a grid's
/// blocks along z, put into one that was allocated for its shape. Else as uploadFreeLengths().
Result<SkipTexture> allocateFreeLengths(glm::ivec3 blocks, const gl::Caps& caps);
Result<void> uploadSlices(const SkipTexture& into, const FreeLengths& lengths, int begin, int end);

} // namespace slabcast

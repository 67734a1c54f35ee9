#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/gl/caps.h"
#include "core/gl/texture_upload.h"
#include "core/volume/normals.h"
#include "core/volume/texels.h"

namespace slabcast {

/// How a volume's scalars, its pre-classified colours and its normals lie in their textures.
const TexelLayout& texelLayoutOf(TexelFormat format);
const TexelLayout& classifiedLayout();
const TexelLayout& normalsLayout();

/// Like every upload of core/gl/texture_upload.h. Fail: also VolumeTooLarge.

/// Scalars: R8, R16 and R16F filtered; Rg8Exact (r high byte, g low byte) and R32fExact for
/// texelFetch.
Result<gl::Texture> uploadTexels(const Texels& texels, const gl::Caps& caps);

/// Pre-classified texels, RGBA8, filtered. `texels` holds dims.x * dims.y * dims.z, x fastest.
Result<gl::Texture> uploadClassified(const glm::u8vec4* texels, glm::ivec3 dims,
                                     const gl::Caps& caps);

/// Baked normals, RGBA8 signed, filtered.
Result<gl::Texture> uploadNormals(const NormalTexels& normals, const gl::Caps& caps);

/// A transfer table as it is uploaded; the texels are borrowed.
struct TableTexels {
    const void* data = nullptr;
    glm::ivec2 size{0};
    TexelLayout layout{};
};

/// By one value: RGBA16F, or RGBA32F where `wide`; one row, for texelFetch.
TableTexels tableTexels(const std::vector<glm::vec4>& texels, bool wide);
/// For the device's filter.
TableTexels filteredTableTexels(const std::vector<glm::vec4>& texels);
/// By both ends of an interval: RGBA16F, as wide as high, filtered.
TableTexels squareTableTexels(const std::vector<glm::u16vec4>& halfs);
/// Fails: InvalidArgument (empty, or longer than the device takes).
Result<void> checkTable(const TableTexels& table, const gl::Caps& caps);

/// A table of one row, checked and uploaded.
Result<gl::Texture> uploadTable(const std::vector<glm::vec4>& texels, bool wide,
                                const gl::Caps& caps);

} // namespace slabcast

#include "core/gl/texture_upload.h"

#include <algorithm>

#include "core/gl/debug.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

void setSampling(GLenum target, GLint filter) {
    gl::TexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    gl::TexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    gl::TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl::TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl::TexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

/// In slabs of 16 MiB, so that the driver's staging copy stays small beside the volume.
void uploadSlabs(const TexelLayout& layout, const Slices& slices, const std::byte* data) {
    const glm::ivec3 dims = slices.dims;
    constexpr std::int64_t kSlabBytes = 16 << 20;
    const std::int64_t sliceBytes = std::int64_t{dims.x} * dims.y * layout.bytesPerTexel;
    const int depth =
        static_cast<int>(std::clamp<std::int64_t>(kSlabBytes / sliceBytes, 1, dims.z));
    for (int z = 0; z < dims.z; z += depth) {
        gl::TexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, slices.first + z, dims.x, dims.y,
                          std::min(depth, dims.z - z), layout.format, layout.type,
                          data + z * sliceBytes);
    }
}

std::string described(const char* label, glm::ivec3 dims) {
    return std::string(label) + " (" + std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" +
           std::to_string(dims.z) + ")";
}

} // namespace

Result<void> takeUploadError(const std::string& what) {
    const GLenum error = gl::takeError();
    if (error == GL_NO_ERROR) {
        return {};
    }
    if (error == GL_OUT_OF_MEMORY) {
        return fail(ErrorCode::DeviceOutOfMemory, "the GPU has no memory left for " + what +
                                                      "; load a smaller volume (--downsample 2)");
    }
    return fail(ErrorCode::Internal, "uploading " + what + " raised " + gl::errorName(error));
}

Result<gl::Texture> upload2d(const char* label, const TexelLayout& layout, glm::ivec2 size,
                             const void* texels) {
    return allocate2d(label, layout, size).map([&](gl::Texture&& texture) {
        fill2d(texture, layout, size, texels);
        return std::move(texture);
    });
}

Result<gl::Texture> allocate2d(const char* label, const TexelLayout& layout, glm::ivec2 size) {
    gl::takeError(); // what came before is not ours
    gl::Texture texture = gl::Texture::make(label, GL_TEXTURE_2D);
    gl::BindTexture(GL_TEXTURE_2D, texture.id());
    gl::TexStorage2D(GL_TEXTURE_2D, 1, layout.internalFormat, size.x, size.y);
    setSampling(GL_TEXTURE_2D, layout.filter);
    return takeUploadError(std::string("the ") + label).map([&] { return std::move(texture); });
}

void fill2d(const gl::Texture& texture, const TexelLayout& layout, glm::ivec2 size,
            const void* texels) {
    gl::StateGuard::usePlainUnpacking();
    gl::BindTexture(GL_TEXTURE_2D, texture.id());
    gl::TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, layout.format, layout.type, texels);
}

Result<gl::Texture> allocate3d(const char* label, const TexelLayout& layout, glm::ivec3 dims) {
    gl::takeError(); // what came before is not ours
    gl::Texture texture = gl::Texture::make(label, GL_TEXTURE_3D);
    gl::BindTexture(GL_TEXTURE_3D, texture.id());
    gl::TexStorage3D(GL_TEXTURE_3D, 1, layout.internalFormat, dims.x, dims.y, dims.z);
    setSampling(GL_TEXTURE_3D, layout.filter);
    return takeUploadError(described(label, dims)).map([&] { return std::move(texture); });
}

Result<void> fillSlices(const char* label, const gl::Texture& texture, const TexelLayout& layout,
                        const Slices& slices, const void* texels) {
    gl::StateGuard::usePlainUnpacking();
    gl::takeError();
    gl::BindTexture(GL_TEXTURE_3D, texture.id());
    uploadSlabs(layout, slices, static_cast<const std::byte*>(texels));
    return takeUploadError(described(label, slices.dims));
}

Result<gl::Texture> upload3d(const char* label, const TexelLayout& layout, glm::ivec3 dims,
                             const void* texels) {
    Result<gl::Texture> texture = allocate3d(label, layout, dims);
    if (!texture) {
        return texture;
    }
    return fillSlices(label, *texture, layout, {dims}, texels).map([&] {
        return std::move(*texture);
    });
}

} // namespace slabcast

#include "core/volume/volume_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/gl/debug.h"
#include "core/gl/state_guard.h"

namespace slabcast {

namespace {

using Layout = TexelLayout;

// In the order of TexelFormat.
constexpr Layout kTexelLayouts[] = {
    {GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR, 1},
    {GL_R16_EXT, GL_RED, GL_UNSIGNED_SHORT, GL_LINEAR, 2},
    {GL_R16F, GL_RED, GL_HALF_FLOAT, GL_LINEAR, 2},
    {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, GL_NEAREST, 2},
    {GL_R32F, GL_RED, GL_FLOAT, GL_NEAREST, 4},
};
constexpr Layout kClassifiedLayout = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR, 4};

const Layout& layoutOf(TexelFormat format) {
    return kTexelLayouts[static_cast<std::size_t>(format)];
}

std::string text(glm::ivec3 dims) {
    return std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" + std::to_string(dims.z);
}

Result<std::int64_t> textureBytes(glm::ivec3 dims, std::int64_t bytesPerTexel) {
    const auto texels = checkedByteCount(glm::i64vec3(dims), VoxelType::U8);
    if (texels && *texels > std::numeric_limits<std::int64_t>::max() / bytesPerTexel) {
        return fail(ErrorCode::SizeOverflow,
                    "a volume of " + text(dims) + " voxels has more bytes than can be counted");
    }
    return texels.map([&](std::int64_t count) { return count * bytesPerTexel; });
}

struct Limits {
    std::int64_t edge;
    std::optional<std::int64_t> bytes;

    bool hold(glm::ivec3 dims, std::int64_t bytesPerTexel) const {
        const int longest = std::max({dims.x, dims.y, dims.z});
        const auto needed = textureBytes(dims, bytesPerTexel);
        return longest <= edge && needed && *needed <= bytes.value_or(*needed);
    }
};

/// Smallest N whose every N-th voxel fits; 0 where not even one voxel would.
int smallestDownsampling(glm::ivec3 dims, std::int64_t bytesPerTexel, const Limits& limits) {
    const int longest = std::max({dims.x, dims.y, dims.z});
    const auto fits = [&](int n) { return limits.hold((dims - 1) / n + 1, bytesPerTexel); };
    if (!fits(longest)) {
        return 0;
    }
    int tooSmall = 0;
    int enough = longest;
    while (enough - tooSmall > 1) {
        const int middle = tooSmall + (enough - tooSmall) / 2;
        (fits(middle) ? enough : tooSmall) = middle;
    }
    return enough;
}

Result<void> checkExtent(glm::ivec3 dims, std::int64_t bytesPerTexel, const Limits& limits) {
    const auto bytes = textureBytes(dims, bytesPerTexel);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    if (limits.hold(dims, bytesPerTexel)) {
        return {};
    }
    const bool edgeTooLong = std::max({dims.x, dims.y, dims.z}) > limits.edge;
    const std::string limit =
        edgeTooLong ? "the device's 3D textures end at " + std::to_string(limits.edge) +
                          " texels along an edge"
                    : "it needs " + std::to_string(*bytes) +
                          " bytes of GPU memory, the budget is " + std::to_string(*limits.bytes);
    const int downsampling = smallestDownsampling(dims, bytesPerTexel, limits);
    return fail(ErrorCode::VolumeTooLarge,
                "the volume has " + text(dims) + " voxels, but " + limit +
                    (downsampling == 0
                         ? "; raise the budget: no downsampling fits"
                         : "; load it with --downsample " + std::to_string(downsampling)));
}

void setSampling(GLenum target, GLint filter) {
    gl::TexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    gl::TexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    gl::TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl::TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl::TexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

/// In slabs of 16 MiB, so that the driver's staging copy stays small beside the volume.
void uploadSlabs(const Layout& layout, const Slices& slices, const std::byte* data) {
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

Result<gl::Texture> uploadVoxels(const char* label, const Layout& layout, glm::ivec3 dims,
                                 const void* data, const gl::Caps& caps) {
    const auto fits =
        checkExtent(dims, layout.bytesPerTexel, {caps.maxTexture3DSize, std::nullopt});
    if (!fits) {
        return tl::unexpected(fits.error());
    }
    return upload3d(label, layout, dims, data);
}

std::string described(const char* label, glm::ivec3 dims) {
    return std::string(label) + " (" + text(dims) + ")";
}

/// A transfer table.
Result<gl::Texture> uploadTable2d(glm::i64vec2 size, GLenum format, GLint filter, GLenum type,
                                  const void* texels, const gl::Caps& caps) {
    // As wide as high, or one row: no table is higher than wide.
    if (size.x == 0 || size.x > caps.maxTextureSize) {
        return fail(ErrorCode::InvalidArgument, "a transfer table of " + std::to_string(size.x) +
                                                    " entries; the device takes 1 to " +
                                                    std::to_string(caps.maxTextureSize));
    }
    return upload2d("transfer table", {format, GL_RGBA, type, filter, 0}, size, texels);
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
    const gl::StateGuard guard;
    gl::StateGuard::usePlainPixelTransfer();
    gl::takeError();
    gl::Texture texture = gl::Texture::make(label, GL_TEXTURE_2D);
    gl::BindTexture(GL_TEXTURE_2D, texture.id());
    gl::TexStorage2D(GL_TEXTURE_2D, 1, layout.internalFormat, size.x, size.y);
    setSampling(GL_TEXTURE_2D, layout.filter);
    gl::TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, layout.format, layout.type, texels);
    if (const auto uploaded = takeUploadError(std::string("the ") + label); !uploaded) {
        return tl::unexpected(uploaded.error());
    }
    return texture;
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
    const gl::StateGuard guard;
    gl::StateGuard::usePlainPixelTransfer();
    gl::takeError();
    gl::BindTexture(GL_TEXTURE_3D, texture.id());
    uploadSlabs(layout, slices, static_cast<const std::byte*>(texels));
    return takeUploadError(described(label, slices.dims));
}

Result<gl::Texture> upload3d(const char* label, const TexelLayout& layout, glm::ivec3 dims,
                             const void* texels) {
    const gl::StateGuard guard;
    Result<gl::Texture> texture = allocate3d(label, layout, dims);
    if (!texture) {
        return texture;
    }
    return fillSlices(label, *texture, layout, {dims}, texels).map([&] {
        return std::move(*texture);
    });
}

std::int64_t uploadedBytesPerTexel(TexelFormat format, bool preclassified) {
    return (preclassified ? kClassifiedLayout : layoutOf(format)).bytesPerTexel;
}

Result<MemoryForecast> forecastMemory(glm::ivec3 dims, VoxelType type, TexelFormat format,
                                      bool preclassified) {
    const auto voxels = checkedByteCount(glm::i64vec3(dims), type);
    const auto texels = forecastTextureBytes(dims, format);
    const auto uploaded = textureBytes(dims, uploadedBytesPerTexel(format, preclassified));
    const auto codes = textureBytes(dims, 2);
    for (const Result<std::int64_t>* part : {&voxels, &texels, &uploaded, &codes}) {
        if (!*part) {
            return tl::unexpected(part->error());
        }
    }
    return MemoryForecast{.gpuTexelBytes = *uploaded,
                          .hostVoxelBytes = *voxels,
                          .hostTexelBytes = *texels,
                          .hostClassifiedBytes = preclassified ? *uploaded : 0,
                          .hostCodeBytes = *codes};
}

Result<std::int64_t> forecastTextureBytes(glm::ivec3 dims, TexelFormat format) {
    return textureBytes(dims, layoutOf(format).bytesPerTexel);
}

Result<void> checkFits(glm::ivec3 dims, std::int64_t bytesPerTexel, const gl::Caps& caps,
                       std::optional<std::int64_t> gpuBudgetBytes) {
    return checkExtent(dims, bytesPerTexel, {caps.maxTexture3DSize, gpuBudgetBytes});
}

Result<gl::Texture> uploadTexels(const Texels& texels, const gl::Caps& caps) {
    if (texels.format == TexelFormat::R16 && !caps.norm16) {
        return fail(ErrorCode::DeviceUnsupported,
                    "the device has no R16 textures (EXT_texture_norm16); choose R16F");
    }
    const auto bytes = forecastTextureBytes(texels.dims, texels.format);
    SLABCAST_EXPECTS(!bytes || *bytes == static_cast<std::int64_t>(texels.data.size()),
                     texels.data.size());
    return uploadVoxels("volume texels", layoutOf(texels.format), texels.dims, texels.data.data(),
                        caps);
}

Result<gl::Texture> uploadClassified(const glm::u8vec4* texels, glm::ivec3 dims,
                                     const gl::Caps& caps) {
    return uploadVoxels("classified texels", kClassifiedLayout, dims, texels, caps);
}

Result<gl::Texture> uploadTable(const std::vector<glm::vec4>& texels, bool wide,
                                const gl::Caps& caps) {
    return uploadTable2d({static_cast<std::int64_t>(texels.size()), 1},
                         wide ? GL_RGBA32F : GL_RGBA16F, GL_NEAREST, GL_FLOAT, texels.data(), caps);
}

Result<gl::Texture> uploadSquareTable(const std::vector<glm::u16vec4>& halfs,
                                      const gl::Caps& caps) {
    const auto edge = std::llround(std::sqrt(static_cast<double>(halfs.size())));
    SLABCAST_EXPECTS(edge * edge == static_cast<std::int64_t>(halfs.size()), edge);
    return uploadTable2d({edge, edge}, GL_RGBA16F, GL_LINEAR, GL_HALF_FLOAT, halfs.data(), caps);
}

} // namespace slabcast

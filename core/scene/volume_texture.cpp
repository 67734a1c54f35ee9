#include "core/scene/volume_texture.h"

#include <cmath>
#include <string>

#include "core/scene/memory_forecast.h"

namespace slabcast {

namespace {

// In the order of TexelFormat.
constexpr TexelLayout kTexelLayouts[] = {
    {GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR, 1},
    {GL_R16_EXT, GL_RED, GL_UNSIGNED_SHORT, GL_LINEAR, 2},
    {GL_R16F, GL_RED, GL_HALF_FLOAT, GL_LINEAR, 2},
    {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, GL_NEAREST, 2},
    {GL_R32F, GL_RED, GL_FLOAT, GL_NEAREST, 4},
};
constexpr TexelLayout kClassifiedLayout = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR, 4};
// Signed: a gradient of zero is zero in every filter.
constexpr TexelLayout kNormalsLayout = {GL_RGBA8_SNORM, GL_RGBA, GL_BYTE, GL_LINEAR, 4};

Result<gl::Texture> uploadVoxels(const char* label, const TexelLayout& layout, glm::ivec3 dims,
                                 const void* data, const gl::Caps& caps) {
    if (const auto fits = checkFits(dims, layout.bytesPerTexel, caps); !fits) {
        return tl::unexpected(fits.error());
    }
    return upload3d(label, layout, dims, data);
}

} // namespace

const TexelLayout& texelLayoutOf(TexelFormat format) {
    return kTexelLayouts[static_cast<std::size_t>(format)];
}

const TexelLayout& classifiedLayout() {
    return kClassifiedLayout;
}

const TexelLayout& normalsLayout() {
    return kNormalsLayout;
}

Result<gl::Texture> uploadNormals(const NormalTexels& normals, const gl::Caps& caps) {
    return uploadVoxels("baked normals", kNormalsLayout, normals.dims, normals.texels.data(), caps);
}

Result<gl::Texture> uploadTexels(const Texels& texels, const gl::Caps& caps) {
    if (texels.format == TexelFormat::R16 && !caps.norm16) {
        return fail(ErrorCode::DeviceUnsupported,
                    "the device has no R16 textures (EXT_texture_norm16); choose R16F");
    }
    const auto bytes = forecastTextureBytes(texels.dims, texels.format);
    SLABCAST_EXPECTS(!bytes || *bytes == static_cast<std::int64_t>(texels.data.size()),
                     texels.data.size());
    return uploadVoxels("volume texels", texelLayoutOf(texels.format), texels.dims,
                        texels.data.data(), caps);
}

Result<gl::Texture> uploadClassified(const glm::u8vec4* texels, glm::ivec3 dims,
                                     const gl::Caps& caps) {
    return uploadVoxels("classified texels", kClassifiedLayout, dims, texels, caps);
}

TableTexels tableTexels(const std::vector<glm::vec4>& texels, bool wide) {
    const TexelLayout layout = wide ? TexelLayout{GL_RGBA32F, GL_RGBA, GL_FLOAT, GL_NEAREST, 16}
                                    : TexelLayout{GL_RGBA16F, GL_RGBA, GL_FLOAT, GL_NEAREST, 8};
    return {texels.data(), {static_cast<int>(texels.size()), 1}, layout};
}

TableTexels filteredTableTexels(const std::vector<glm::vec4>& texels) {
    return {texels.data(),
            {static_cast<int>(texels.size()), 1},
            {GL_RGBA16F, GL_RGBA, GL_FLOAT, GL_LINEAR, 8}};
}

TableTexels squareTableTexels(const std::vector<glm::u16vec4>& halfs) {
    const int edge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(halfs.size()))));
    SLABCAST_EXPECTS(std::int64_t(edge) * edge == static_cast<std::int64_t>(halfs.size()), edge);
    return {halfs.data(), glm::ivec2(edge), {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, GL_LINEAR, 8}};
}

Result<void> checkTable(const TableTexels& table, const gl::Caps& caps) {
    // As wide as high, or one row: no table is higher than wide.
    if (table.size.x == 0 || table.size.x > caps.maxTextureSize) {
        return fail(ErrorCode::InvalidArgument,
                    "a transfer table of " + std::to_string(table.size.x) +
                        " entries; the device takes 1 to " + std::to_string(caps.maxTextureSize));
    }
    return {};
}

Result<gl::Texture> uploadTable(const std::vector<glm::vec4>& texels, bool wide,
                                const gl::Caps& caps) {
    const TableTexels table = tableTexels(texels, wide);
    return checkTable(table, caps).and_then([&] {
        return upload2d("transfer table", table.layout, table.size, table.data);
    });
}

} // namespace slabcast

#include "core/scene/memory_forecast.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/scene/volume_texture.h"

namespace slabcast {

namespace {

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

} // namespace

std::int64_t uploadedBytesPerVoxel(TexelFormat format, const Needs& needs) {
    const bool preclassified = needs.classification == Classification::Pre;
    return (preclassified ? classifiedLayout() : texelLayoutOf(format)).bytesPerTexel +
           (needs.normals ? normalsLayout().bytesPerTexel : 0);
}

Result<MemoryForecast> forecastMemory(glm::ivec3 dims, VoxelType type, TexelFormat format,
                                      const Needs& needs) {
    const bool preclassified = needs.classification == Classification::Pre;
    const auto voxels = checkedByteCount(glm::i64vec3(dims), type);
    const auto texels = forecastTextureBytes(dims, format);
    const auto uploaded = textureBytes(dims, uploadedBytesPerVoxel(format, needs));
    const auto normals =
        needs.normals ? textureBytes(dims, normalsLayout().bytesPerTexel) : Result<std::int64_t>(0);
    // Texels as long as voxels take their place: encodeTexels().
    const bool inPlace = bytesPerTexel(format) == bytesPerVoxel(type);
    // Of 8-bit scalars they are the texels themselves, of pre-classified ones their alphas.
    const bool ownCodes = format == TexelFormat::R8 && !preclassified;
    const auto codes =
        ownCodes ? Result<std::int64_t>(0) : textureBytes(dims, preclassified ? 1 : 2);
    for (const Result<std::int64_t>* part : {&voxels, &texels, &uploaded, &normals, &codes}) {
        if (!*part) {
            return tl::unexpected(part->error());
        }
    }
    return MemoryForecast{.gpuTexelBytes = *uploaded,
                          .hostVoxelBytes = *voxels,
                          .hostTexelBytes = inPlace ? 0 : *texels,
                          .hostClassifiedBytes = preclassified ? *uploaded : 0,
                          .hostNormalsBytes = *normals,
                          .hostCodeBytes = *codes};
}

Result<std::int64_t> forecastTextureBytes(glm::ivec3 dims, TexelFormat format) {
    return textureBytes(dims, texelLayoutOf(format).bytesPerTexel);
}

Result<void> checkFits(glm::ivec3 dims, std::int64_t bytesPerTexel, const gl::Caps& caps,
                       std::optional<std::int64_t> gpuBudgetBytes) {
    return checkExtent(dims, bytesPerTexel, {caps.maxTexture3DSize, gpuBudgetBytes});
}

Result<void> checkRoom(glm::ivec3 dims, std::int64_t bytesPerTexel) {
    constexpr std::int64_t kFewBytes = std::int64_t{256} << 20;
    const Result<std::int64_t> bytes = textureBytes(dims, bytesPerTexel);
    if (!bytes || *bytes < kFewBytes) {
        return bytes.map([](std::int64_t) {});
    }
    SLABCAST_EXPECTS(bytesPerTexel == 1 || bytesPerTexel == 2 || bytesPerTexel == 4, bytesPerTexel);
    const TexelLayout& layout = bytesPerTexel == 4   ? classifiedLayout()
                                : bytesPerTexel == 2 ? texelLayoutOf(TexelFormat::Rg8Exact)
                                                     : texelLayoutOf(TexelFormat::R8);
    return allocate3d("volume texels", layout, dims).map([](const gl::Texture&) {});
}

} // namespace slabcast

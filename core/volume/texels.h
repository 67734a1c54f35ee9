#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/volume/statistics.h"
#include "core/volume/volume.h"

namespace slabcast {

/// How scalar voxels lie in a 3D texture.
/// R8, R16, R16F are filtered by the texture unit. Rg8Exact (16-bit integers as high and low byte)
/// and R32fExact are fetched eight times and interpolated in the shader, in float32.
enum class TexelFormat : std::uint8_t { R8, R16, R16F, Rg8Exact, R32fExact };

const char* name(TexelFormat format);
std::size_t bytesPerTexel(TexelFormat format);
bool isExact(TexelFormat format);
/// Whether the format keeps every voxel of the type, whatever the values: 8 bits in all formats, 16
/// in R16 and the exact ones, float32 in R32fExact.
bool keepsEveryVoxel(TexelFormat format, VoxelType type);
/// Width of the range that the format's sampled values span: 1 for R8 and R16, 4096 for R16F.
double fullScaleSampled(TexelFormat format);

/// The texture's host copy. What the shader's field function returns for a texel is `sampled`
/// (R8, R16: texel/max; R16F, R32fExact: the float; Rg8Exact: high*256+low), and the data value is
/// `valueScale * sampled + valueBias`. The scale is positive, also for data with a negative slope:
/// sampled order is value order.
struct Texels {
    TexelFormat format = TexelFormat::R8;
    glm::ivec3 dims{0};
    double valueScale = 1.0;
    double valueBias = 0.0;
    double maxQuantisationError =
        0.0;         // measured over all voxels, in data units; 0 where every voxel is kept exactly
    VoxelBytes data; // x fastest, tightly packed
};

/// Cost: one pass, all cores. R16F is offset and scaled so that integers of up to 12 bits stay
/// exact (fp16 holds integers exactly to +-2048) and wider data use the format's best range. R8,
/// R16 and Rg8Exact keep integers whose range fits exactly, and divide [min, max] into 255 or
/// 65,535 even steps otherwise. R32fExact keeps floats as they are and integers within 2^25 steps.
/// Values outside the statistics are clamped by integer formats.
/// Tested by: texels_test.cpp
Texels encodeTexels(const Volume& volume, const VolumeStatistics& statistics, TexelFormat format);
/// The same, and the voxels are gone: where a texel is as long as a voxel, into their memory, so
/// that nothing is allocated. 8-bit voxels from 0 on are their own texels, without a pass.
Texels encodeTexels(Volume&& volume, const VolumeStatistics& statistics, TexelFormat format);

/// Data value of one texel as the renderer decodes it.
double decodedValue(const Texels& texels, glm::ivec3 voxel);

/// A monotone integer code per texel: code order is value order, so minima and maxima may be taken
/// of codes. Code c stands for sampled values in [low(c), high(c)]; low == high except for
/// R32fExact, whose floats are binned.
struct TexelCodes {
    glm::ivec3 dims{0};
    std::vector<std::uint16_t> codes;    // x fastest; empty where they are bytes
    std::span<const std::uint8_t> bytes; // of 8-bit texels, instead
    std::shared_ptr<const void> owner;   // of the bytes; none: the caller sees to that
    std::vector<float> lowSampled;       // 65,536 entries, or 256 for 8-bit texels
    std::vector<float> highSampled;

    std::int64_t count() const {
        return static_cast<std::int64_t>(bytes.empty() ? codes.size() : bytes.size());
    }
    /// Calls visit(pointer) with the codes as they are held.
    template <class Visitor>
    decltype(auto) visit(Visitor&& visitor) const {
        return bytes.empty() ? visitor(codes.data()) : visitor(bytes.data());
    }
};

/// 8-bit texels are their own codes, which take no memory then: they are `owner`'s, or the caller
/// keeps them. Others take 2 bytes each. Cost: one pass, all cores; none of 8-bit texels.
/// Tested by: texels_test.cpp
TexelCodes encodeCodes(const Texels& texels, std::shared_ptr<const void> owner = nullptr);

/// Of binned floats, per code: the least float that has this code or a greater one, infinity where
/// none has. Cost: O(codes), all cores. Tested by: gpu_builder_gl_test.cpp
std::vector<float> codeStarts(const TexelCodes& codes);

} // namespace slabcast

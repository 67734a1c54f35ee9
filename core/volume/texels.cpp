#include "core/volume/texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/volume/texel_codec.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

constexpr std::int64_t kGrain = 1 << 18;
constexpr std::array kFormatNames{"r8", "r16", "r16f", "rg8-exact", "r32f-exact"};

/// stored voxel = offset + step * units of the codec. The step has the slope's sign, so that more
/// units are always a higher data value.
struct Mapping {
    double offset = 0.0;
    double step = 1.0;
};

/// The stored voxel that has this data value; for integers the one that it was computed from.
template <class T>
double storedVoxel(const Volume& volume, double dataValue) {
    const double stored = (dataValue - volume.rescaleIntercept) / volume.rescaleSlope;
    if constexpr (std::is_integral_v<T>) {
        using Limits = std::numeric_limits<T>;
        return std::clamp(std::round(stored), double{Limits::min()}, double{Limits::max()});
    } else {
        return stored;
    }
}

/// Power of two by which floats are stored: 1, but for those so small that a GPU takes them for
/// zero, or so large that differences of them overflow.
double floatStep(double first, double last) {
    constexpr int kLeastStep = -1000;      // whose inverse is finite in float64
    constexpr int kSmallestExponent = -64; // leaves room for a table's texels per value
    constexpr int kLargestExponent = 125;
    const double largest = std::max(std::abs(first), std::abs(last));
    const int exponent = largest > 0.0 ? std::ilogb(largest) : 0;
    if (exponent < kSmallestExponent) {
        return std::ldexp(1.0, std::max(exponent, kLeastStep));
    }
    return exponent > kLargestExponent ? 4.0 : 1.0;
}

/// Integers whose range fits are kept as they are, a step each; floats in a float format too. All
/// else is spread evenly over the format's exact range, which is where its error is smallest: fp16
/// over +-2048 errs by at most 2^-13 of the range.
template <class T, class Codec>
Mapping mappingFor(const Volume& volume, const VolumeStatistics& statistics) {
    const double sign = volume.rescaleSlope > 0.0 ? 1.0 : -1.0;
    constexpr bool kStoresFloats = std::is_same_v<typename Codec::Texel, float>;
    const double first = storedVoxel<T>(volume, statistics.min);
    const double last = storedVoxel<T>(volume, statistics.max);
    if constexpr (kStoresFloats && std::is_floating_point_v<T>) {
        return {0.0, sign * floatStep(first, last)};
    }
    const double range = std::abs(last - first);
    // A range that float64 itself no longer divides is none.
    const bool constant = range / Codec::kExactUnits < std::numeric_limits<double>::min();
    const bool stepEach =
        kStoresFloats || constant || (std::is_integral_v<T> && range <= Codec::kExactUnits);
    const double step = stepEach ? sign : sign * range / Codec::kExactUnits;
    const double centre = Codec::kCentred ? std::round(0.5 * range / std::abs(step)) : 0.0;
    return {first + step * centre, step};
}

/// Packs all voxels. Returns the largest difference to what was meant, in stored steps.
template <class T, class Codec>
double packAll(std::span<const T> voxels, Mapping mapping, Codec codec, std::byte* out) {
    auto* texels = reinterpret_cast<typename Codec::Texel*>(out);
    const auto count = static_cast<std::int64_t>(voxels.size());
    const double unitsPerStep = 1.0 / mapping.step;
    std::vector<double> errors(static_cast<std::size_t>((count + kGrain - 1) / kGrain), 0.0);
    parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
        double largest = 0.0;
        for (std::int64_t i = begin; i < end; ++i) {
            const auto voxel = static_cast<double>(voxels[static_cast<std::size_t>(i)]);
            texels[i] = codec.pack((voxel - mapping.offset) * unitsPerStep);
            const double kept = mapping.offset + mapping.step * codec.unpack(texels[i]);
            largest = std::max(largest, std::abs(kept - voxel));
        }
        errors[static_cast<std::size_t>(begin / kGrain)] = largest;
    });
    return *std::max_element(errors.begin(), errors.end());
}

} // namespace

const char* name(TexelFormat format) {
    const auto index = static_cast<std::size_t>(format);
    SLABCAST_EXPECTS(index < kFormatNames.size(), index);
    return kFormatNames[index];
}

std::size_t bytesPerTexel(TexelFormat format) {
    return visitTexelFormat(format,
                            []<class Codec>(Codec) { return sizeof(typename Codec::Texel); });
}

bool isExact(TexelFormat format) {
    return format == TexelFormat::Rg8Exact || format == TexelFormat::R32fExact;
}

double fullScaleSampled(TexelFormat format) {
    return visitTexelFormat(format,
                            [](auto codec) { return codec.kExactUnits / codec.kUnitsPerSampled; });
}

Texels encodeTexels(const Volume& volume, const VolumeStatistics& statistics, TexelFormat format) {
    SLABCAST_EXPECTS(!volume.voxels.empty(), volume.voxels.size());
    return visitVoxels(volume, [&]<class T>(std::span<const T> voxels) {
        return visitTexelFormat(format, [&]<class Codec>(Codec codec) {
            const auto mapping = mappingFor<T, Codec>(volume, statistics);
            Texels texels;
            texels.format = format;
            texels.dims = volume.geometry.dims;
            texels.valueScale = volume.rescaleSlope * mapping.step * Codec::kUnitsPerSampled;
            texels.valueBias = volume.rescaleSlope * mapping.offset + volume.rescaleIntercept;
            texels.data.resize(voxels.size() * sizeof(typename Codec::Texel));
            texels.maxQuantisationError =
                std::abs(volume.rescaleSlope) * packAll(voxels, mapping, codec, texels.data.data());
            return texels;
        });
    });
}

double decodedValue(const Texels& texels, glm::ivec3 voxel) {
    const glm::ivec3 dims = texels.dims;
    SLABCAST_EXPECTS(glm::all(glm::lessThan(glm::uvec3(voxel), glm::uvec3(dims))), voxel.x);
    const std::int64_t index =
        (std::int64_t{voxel.z} * dims.y + voxel.y) * std::int64_t{dims.x} + voxel.x;
    return visitTexelFormat(texels.format, [&]<class Codec>(Codec codec) {
        const double units = codec.unpack(texelData(texels, codec)[index]);
        return texels.valueScale * (units / Codec::kUnitsPerSampled) + texels.valueBias;
    });
}

} // namespace slabcast

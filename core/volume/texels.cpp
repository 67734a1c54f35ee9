#include "core/volume/texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

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

template <class T>
T at(const std::byte* values, std::int64_t index) {
    T value;
    std::memcpy(&value, values + index * static_cast<std::int64_t>(sizeof(T)), sizeof(T));
    return value;
}

template <class T>
void put(std::byte* values, std::int64_t index, T value) {
    std::memcpy(values + index * static_cast<std::int64_t>(sizeof(T)), &value, sizeof(T));
}

/// The largest of what `body` returns for runs that cover [0, count).
template <class Body>
double largestOfRuns(std::int64_t count, const Body& body) {
    std::vector<double> errors(static_cast<std::size_t>((count + kGrain - 1) / kGrain), 0.0);
    parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
        errors[static_cast<std::size_t>(begin / kGrain)] = body(begin, end);
    });
    return *std::max_element(errors.begin(), errors.end());
}

/// Voxels of which each is `count` whole units of an integer format, or beyond its ends.
template <class T, class Texel>
constexpr bool kMayBeShifted = std::is_integral_v<T> && sizeof(T) <= 2 && std::is_integral_v<Texel>;

/// As packAll(), of these, without floating point.
template <class T, class Texel>
double shiftAll(const std::byte* voxels, std::int64_t count, Mapping mapping, std::byte* texels) {
    const int sign = mapping.step > 0.0 ? 1 : -1;
    const int offset = static_cast<int>(mapping.offset);
    constexpr int kMost = std::numeric_limits<Texel>::max();
    if (voxels == texels && sign > 0 && offset == 0 && std::is_same_v<T, Texel>) {
        return 0.0;
    }
    return largestOfRuns(count, [=](std::int64_t begin, std::int64_t end) {
        int largest = 0;
        for (std::int64_t i = begin; i < end; ++i) {
            const int units = sign * (int{at<T>(voxels, i)} - offset);
            const int kept = std::clamp(units, 0, kMost);
            put(texels, i, static_cast<Texel>(kept));
            largest = std::max(largest, std::abs(units - kept));
        }
        return static_cast<double>(largest);
    });
}

/// Packs all voxels, also into the memory that they lie in, where texels are as long. Returns the
/// largest difference to what was meant, in stored steps.
template <class T, class Codec>
double packAll(const std::byte* voxels, std::int64_t count, Mapping mapping, Codec codec,
               std::byte* texels) {
    using Texel = typename Codec::Texel;
    if constexpr (kMayBeShifted<T, Texel> && !Codec::kCentred) {
        if (std::abs(mapping.step) == 1.0) {
            return shiftAll<T, Texel>(voxels, count, mapping, texels);
        }
    }
    const double unitsPerStep = 1.0 / mapping.step;
    return largestOfRuns(count, [=](std::int64_t begin, std::int64_t end) {
        double largest = 0.0;
        for (std::int64_t i = begin; i < end; ++i) {
            const auto voxel = static_cast<double>(at<T>(voxels, i));
            const Texel texel = codec.pack((voxel - mapping.offset) * unitsPerStep);
            put(texels, i, texel);
            const double kept = mapping.offset + mapping.step * codec.unpack(texel);
            largest = std::max(largest, std::abs(kept - voxel));
        }
        return largest;
    });
}

/// Into `data`, which may be the voxels' own memory.
Texels encodeInto(VoxelBytes data, const std::byte* voxels, const Volume& volume,
                  const VolumeStatistics& statistics, TexelFormat format) {
    return visitVoxelType(volume.type, [&]<class T>(std::type_identity<T>) {
        return visitTexelFormat(format, [&]<class Codec>(Codec codec) {
            const auto mapping = mappingFor<T, Codec>(volume, statistics);
            const auto count = static_cast<std::int64_t>(data.size() / bytesPerTexel(format));
            Texels texels;
            texels.format = format;
            texels.dims = volume.geometry.dims;
            texels.valueScale = volume.rescaleSlope * mapping.step * Codec::kUnitsPerSampled;
            texels.valueBias = volume.rescaleSlope * mapping.offset + volume.rescaleIntercept;
            texels.maxQuantisationError = std::abs(volume.rescaleSlope) *
                                          packAll<T>(voxels, count, mapping, codec, data.data());
            texels.data = std::move(data);
            return texels;
        });
    });
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

bool keepsEveryVoxel(TexelFormat format, VoxelType type) {
    if (isFloatingPoint(type)) {
        return format == TexelFormat::R32fExact && type == VoxelType::F32;
    }
    const std::size_t bytes = bytesPerVoxel(type);
    return bytes == 1 || (bytes == 2 && format != TexelFormat::R8 && format != TexelFormat::R16F);
}

Texels encodeTexels(const Volume& volume, const VolumeStatistics& statistics, TexelFormat format) {
    SLABCAST_EXPECTS(!volume.voxels.empty(), volume.voxels.size());
    const std::size_t count = volume.voxels.size() / bytesPerVoxel(volume.type);
    return encodeInto(VoxelBytes(count * bytesPerTexel(format)), volume.voxels.data(), volume,
                      statistics, format);
}

Texels encodeTexels(Volume&& volume, const VolumeStatistics& statistics, TexelFormat format) {
    if (bytesPerTexel(format) != bytesPerVoxel(volume.type)) {
        Texels texels = encodeTexels(std::as_const(volume), statistics, format);
        volume.voxels = {};
        return texels;
    }
    SLABCAST_EXPECTS(!volume.voxels.empty(), volume.voxels.size());
    VoxelBytes own = std::move(volume.voxels);
    const std::byte* voxels = own.data();
    return encodeInto(std::move(own), voxels, volume, statistics, format);
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

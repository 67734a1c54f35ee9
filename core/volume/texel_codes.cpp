#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/base/bits.h"
#include "core/base/parallel.h"
#include "core/volume/texel_codec.h"
#include "core/volume/texels.h"

namespace slabcast {
namespace {

constexpr std::int64_t kGrain = 1 << 18;
constexpr std::size_t kCodes = 65536;

// A coder gives a texel its code, and a code the sampled values that it stands for.

template <class Codec>
struct IntegerCoder {
    explicit IntegerCoder(const Texels& /*texels*/) {}

    static constexpr std::size_t kCount = Codec::kExactUnits < 256.0 ? 256 : kCodes;

    std::uint16_t code(typename Codec::Texel texel) const {
        return static_cast<std::uint16_t>(Codec::unpack(texel));
    }
    float low(std::size_t code) const {
        return static_cast<float>(static_cast<double>(code) / Codec::kUnitsPerSampled);
    }
    float high(std::size_t code) const { return low(code); }
};

/// Bits of a half in the order of its values: negative ones count downwards, below all positive.
struct HalfCoder {
    explicit HalfCoder(const Texels& /*texels*/) {}

    static constexpr std::size_t kCount = kCodes;

    std::uint16_t code(std::uint16_t half) const {
        return static_cast<std::uint16_t>((half & 0x8000U) != 0 ? ~half : half | 0x8000U);
    }
    /// Codes of infinities and NaN, which no texel has, repeat the format's ends.
    float low(std::size_t code) const {
        const auto bits =
            static_cast<std::uint16_t>((code & 0x8000U) != 0 ? code & 0x7fffU : ~code);
        if ((bits & 0x7c00U) == 0x7c00U) {
            return std::copysign(kLargestHalf, (bits & 0x8000U) != 0 ? -1.0F : 1.0F);
        }
        return floatFromHalf(bits);
    }
    float high(std::size_t code) const { return low(code); }
};

/// 65,536 even bins from the smallest float to the largest.
struct FloatCoder {
    FloatCoder(float least, float most)
        : min(least), max(most), binWidth((double{max} - double{min}) / double{kCodes}),
          slack(0x1p-49 * std::max(std::abs(double{min}), std::abs(double{max}))) {}

    static constexpr std::size_t kCount = kCodes;

    std::uint16_t code(float value) const {
        const double bin = binWidth > 0.0 ? (double{value} - double{min}) / binWidth : 0.0;
        return static_cast<std::uint16_t>(std::clamp(bin, 0.0, double{kCodes - 1}));
    }
    float low(std::size_t code) const {
        const double edge = double{min} + static_cast<double>(code) * binWidth - slack;
        return std::clamp(std::nextafter(static_cast<float>(edge), -kInfinity), min, max);
    }
    float high(std::size_t code) const {
        const double edge = double{min} + static_cast<double>(code + 1) * binWidth + slack;
        return std::clamp(std::nextafter(static_cast<float>(edge), kInfinity), min, max);
    }

    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    float min;
    float max;
    double binWidth;
    double slack; // what the float64 arithmetic of `code`, `low` and `high` may be off by
};

template <class Codec>
IntegerCoder<Codec> coderFor(const Texels& texels, Codec /*codec*/) {
    return IntegerCoder<Codec>(texels);
}
HalfCoder coderFor(const Texels& texels, HalfCodec /*codec*/) {
    return HalfCoder(texels);
}
FloatCoder coderFor(const Texels& texels, FloatCodec codec) {
    const float* begin = texelData(texels, codec);
    const auto [least, most] =
        std::minmax_element(begin, begin + texels.data.size() / sizeof(float));
    return {*least, *most};
}

/// Floats as integers in the same order, and back.
std::int64_t orderOf(float value) {
    const auto bits = bitsAs<std::uint32_t>(value);
    const std::int64_t magnitude = bits & 0x7fffffffU;
    return (bits >> 31) != 0 ? -magnitude : magnitude;
}
float floatAt(std::int64_t order) {
    const auto magnitude = bitsAs<float>(static_cast<std::uint32_t>(std::abs(order)));
    return order < 0 ? -magnitude : magnitude;
}

} // namespace

TexelCodes encodeCodes(const Texels& texels, std::shared_ptr<const void> owner) {
    SLABCAST_EXPECTS(!texels.data.empty(), texels.data.size());
    return visitTexelFormat(texels.format, [&](auto codec) {
        const auto coder = coderFor(texels, codec);
        const auto* data = texelData(texels, codec);
        TexelCodes result;
        result.dims = texels.dims;
        const std::size_t count = texels.data.size() / bytesPerTexel(texels.format);
        if constexpr (std::is_same_v<decltype(data), const std::uint8_t*>) {
            result.bytes = {data, count};
            result.owner = std::move(owner);
        } else {
            result.codes.resize(count);
            parallelFor(static_cast<std::int64_t>(count), kGrain,
                        [&](std::int64_t begin, std::int64_t end) {
                            std::transform(data + begin, data + end, result.codes.data() + begin,
                                           [&](auto texel) { return coder.code(texel); });
                        });
        }
        for (std::size_t code = 0; code < coder.kCount; ++code) {
            result.lowSampled.push_back(coder.low(code));
            result.highSampled.push_back(coder.high(code));
        }
        return result;
    });
}

std::vector<float> codeStarts(const TexelCodes& codes) {
    const FloatCoder coder(codes.lowSampled.front(), codes.highSampled.back());
    std::vector<float> starts(codes.lowSampled.size(), FloatCoder::kInfinity);
    parallelFor(static_cast<std::int64_t>(starts.size()), 4096,
                [&](std::int64_t begin, std::int64_t end) {
                    for (std::int64_t code = begin; code < end; ++code) {
                        std::int64_t least = orderOf(coder.min);
                        std::int64_t most = orderOf(coder.max) + 1; // no texel
                        while (least < most) {
                            const std::int64_t middle = least + (most - least) / 2;
                            const bool enough = coder.code(floatAt(middle)) >= code;
                            (enough ? most : least) = enough ? middle : middle + 1;
                        }
                        if (least <= orderOf(coder.max)) {
                            starts[static_cast<std::size_t>(code)] = floatAt(least);
                        }
                    }
                });
    return starts;
}

} // namespace slabcast

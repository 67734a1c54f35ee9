#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/volume/half.h"
#include "core/volume/texels.h"

namespace slabcast {

// A codec packs a number of units into a texel and back. A unit is what the texel counts: one code
// of an integer format, 1.0 of a float format.
//   kExactUnits      so many steps of one unit are held exactly
//   kCentred         they lie around zero, not above it
//   kUnitsPerSampled what the shader reads is unpack(texel) / kUnitsPerSampled

template <class Integer>
struct UnormCodec {
    using Texel = Integer;
    static constexpr double kExactUnits = std::numeric_limits<Integer>::max();
    static constexpr bool kCentred = false;
    static constexpr double kUnitsPerSampled = kExactUnits;

    static Texel pack(double units) {
        return static_cast<Texel>(std::clamp(units, 0.0, kExactUnits) + 0.5);
    }
    static double unpack(Texel texel) { return texel; }
};

/// Red is the high byte, green the low one, on any machine.
struct HighLowCodec {
    using Texel = std::array<std::uint8_t, 2>;
    static constexpr double kExactUnits = 65535.0;
    static constexpr bool kCentred = false;
    static constexpr double kUnitsPerSampled = 1.0;

    static Texel pack(double units) {
        const std::uint16_t code = UnormCodec<std::uint16_t>::pack(units);
        return {static_cast<std::uint8_t>(code >> 8), static_cast<std::uint8_t>(code & 0xffU)};
    }
    static double unpack(Texel texel) { return texel[0] * 256 + texel[1]; }
};

struct HalfCodec {
    using Texel = std::uint16_t;
    static constexpr double kExactUnits = 4096.0; // -2048 to 2048
    static constexpr bool kCentred = true;
    static constexpr double kUnitsPerSampled = 1.0;

    static Texel pack(double units) { return halfFromFloat(static_cast<float>(units)); }
    static double unpack(Texel texel) { return static_cast<double>(floatFromHalf(texel)); }
};

struct FloatCodec {
    using Texel = float;
    static constexpr double kExactUnits = 33554432.0; // -2^24 to 2^24
    static constexpr bool kCentred = true;
    static constexpr double kUnitsPerSampled = 1.0;

    static Texel pack(double units) { return static_cast<float>(units); }
    static double unpack(Texel texel) { return static_cast<double>(texel); }
};

/// Calls `visit(codec)` with the format's codec: the one switch over texel formats.
template <class Visitor>
decltype(auto) visitTexelFormat(TexelFormat format, Visitor&& visit) {
    switch (format) {
    case TexelFormat::R8:
        return visit(UnormCodec<std::uint8_t>{});
    case TexelFormat::R16:
        return visit(UnormCodec<std::uint16_t>{});
    case TexelFormat::R16F:
        return visit(HalfCodec{});
    case TexelFormat::Rg8Exact:
        return visit(HighLowCodec{});
    case TexelFormat::R32fExact:
        return visit(FloatCodec{});
    }
    contractBreach(__func__, "a texel format", static_cast<double>(format));
}

/// The texels, x fastest, as their codec's type.
template <class Codec>
const typename Codec::Texel* texelData(const Texels& texels, Codec /*codec*/) {
    return reinterpret_cast<const typename Codec::Texel*>(texels.data.data());
}

} // namespace slabcast

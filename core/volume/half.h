#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/bits.h"

namespace slabcast {

inline constexpr float kLargestHalf = 65504.0F;
inline constexpr float kSmallestNormalHalf = 0x1p-14F; // below, digits are lost
inline constexpr float kSmallestHalf = 0x1p-24F;       // the smallest positive one, subnormal

/// IEEE binary16 bits, rounded to nearest even as GL does; beyond the largest half: infinity.
/// Source: F. Giesen, float_to_half_fast3_rtne (public domain). Tested by: texels_test.cpp
inline std::uint16_t halfFromFloat(float value) {
    const auto bits = bitsAs<std::uint32_t>(value);
    const auto sign = static_cast<std::uint16_t>((bits >> 16) & 0x8000U);
    const std::uint32_t magnitude = bits & 0x7fffffffU;
    std::uint32_t half = 0;
    if (magnitude > 0x7f800000U) {
        half = 0x7e00U; // NaN
    } else if (magnitude >= 0x47800000U) {
        half = 0x7c00U; // 65536 and above
    } else if (magnitude < 0x38800000U) {
        // Subnormal: adding 0.5 makes the float unit round at the half's last bit.
        half = bitsAs<std::uint32_t>(bitsAs<float>(magnitude) + 0.5F) - 0x3f000000U;
    } else {
        // Rebias the exponent by -112 and round; a carry runs on into the exponent, as it should.
        half = (magnitude - (112U << 23) + 0xfffU + ((magnitude >> 13) & 1U)) >> 13;
    }
    return static_cast<std::uint16_t>(sign | half);
}

inline float floatFromHalf(std::uint16_t half) {
    const std::uint32_t sign = std::uint32_t{half & 0x8000U} << 16;
    const std::uint32_t magnitude = half & 0x7fffU;
    if (magnitude < 0x0400U) { // subnormal: exact in float
        const float value = static_cast<float>(magnitude) * kSmallestHalf;
        return bitsAs<float>(sign | bitsAs<std::uint32_t>(value));
    }
    const std::uint32_t rebias = magnitude < 0x7c00U ? 112U << 23 : 224U << 23; // or infinity, NaN
    return bitsAs<float>(sign | ((magnitude << 13) + rebias));
}

inline float roundedToHalf(float value) {
    return floatFromHalf(halfFromFloat(value));
}

} // namespace slabcast

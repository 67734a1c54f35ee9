#pragma once

#include <array>
#include <span>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// What is off everywhere (bias: the mean of picture - reference) apart from what scatters around
/// it (deviation: its standard deviation): rmse^2 = bias^2 + deviation^2.
struct ErrorMoments {
    double bias = 0.0;
    double deviation = 0.0;
    double rmse = 0.0;
    double max = 0.0; // of the absolute difference
};

/// How far one picture is from another. RMSE, PSNR (peak 1) and largest difference are over R, G, B
/// in the compositing space, composited over black; the perceptual difference is CIEDE2000 per
/// pixel, mean and 99.9th percentile. Equal pictures have a PSNR of infinity.
struct PictureDifference {
    double rmse = 0.0;
    double psnr = 0.0;
    double max = 0.0;
    double meanDeltaE = 0.0;
    double p999DeltaE = 0.0;
    double bias = 0.0; // of R, G and B together, as rmse and max are
    double deviation = 0.0;
    std::array<ErrorMoments, 4> channels; // R, G, B, and alpha on its own
    double visibleShare = 0.0;            // of pixels off by more than 1/255 in any of R, G, B
    double visibleAlphaShare = 0.0;       // in alpha
};

/// What eight bits can show: a difference beyond it counts as visible.
inline constexpr double kVisibleDifference = 1.0 / 255.0;

/// Of two pictures of one size, not empty, premultiplied RGBA (so: over black), in one compositing
/// space. Colours outside [0, 1] are clamped for the perceptual part only.
/// Cost: O(pixels), all cores. Tested by: picture_difference_test.cpp
PictureDifference difference(std::span<const glm::dvec4> picture,
                             std::span<const glm::dvec4> reference, CompositingSpace space);

/// CIE L*a*b* under D65 (2 degrees) of linear light with sRGB's primaries.
glm::dvec3 labFromLinear(glm::dvec3 linear);

/// CIEDE2000 of two L*a*b* colours, all weights 1. Source: CIE 142-2001; Sharma, Wu and Dalal 2005,
/// "The CIEDE2000 color-difference formula: implementation notes".
double deltaE2000(glm::dvec3 lab1, glm::dvec3 lab2);

} // namespace slabcast

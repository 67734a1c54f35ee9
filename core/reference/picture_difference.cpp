#include "core/reference/picture_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/parallel.h"

namespace slabcast {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::int64_t kGrain = 4096; // pixels

double sinDegrees(double degrees) {
    return std::sin(degrees * kPi / 180.0);
}
double cosDegrees(double degrees) {
    return std::cos(degrees * kPi / 180.0);
}

/// chroma^7 / (chroma^7 + 25^7), under a root: how far the formula treats a colour as saturated.
double saturation(double chroma) {
    const double c7 = std::pow(chroma, 7.0);
    return std::sqrt(c7 / (c7 + 6103515625.0));
}

/// In [0, 360); 0 for grey.
double hueDegrees(double a, double b) {
    if (a == 0.0 && b == 0.0) {
        return 0.0;
    }
    const double degrees = std::atan2(b, a) * 180.0 / kPi;
    return degrees < 0.0 ? degrees + 360.0 : degrees;
}

/// Both hues on one turn, less than half a turn apart: their difference and their mean.
struct HuePair {
    double difference = 0.0;
    double mean = 0.0;
};

HuePair pairOf(double hue1, double hue2, bool anyGrey) {
    if (anyGrey) {
        return {0.0, hue1 + hue2}; // the hue of the colour that has one
    }
    const double apart = hue2 - hue1;
    const double sum = hue1 + hue2;
    if (std::abs(apart) <= 180.0) {
        return {apart, sum / 2.0};
    }
    return {apart > 0.0 ? apart - 360.0 : apart + 360.0,
            sum < 360.0 ? (sum + 360.0) / 2.0 : (sum - 360.0) / 2.0};
}

double squared(double x) {
    return x * x;
}

/// Two passes: the sum of squares is taken around the mean, so that a small scatter beside a large
/// bias keeps its digits.
ErrorMoments momentsOf(std::span<const glm::dvec4> picture, std::span<const glm::dvec4> reference,
                       int channel) {
    const auto count = static_cast<double>(picture.size());
    ErrorMoments moments;
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const double apart = picture[i][channel] - reference[i][channel];
        sum += apart;
        moments.max = std::max(moments.max, std::abs(apart));
    }
    moments.bias = sum / count;
    double aroundMean = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        aroundMean += squared(picture[i][channel] - reference[i][channel] - moments.bias);
    }
    moments.deviation = std::sqrt(aroundMean / count);
    moments.rmse = std::hypot(moments.bias, moments.deviation);
    return moments;
}

/// The moments of R, G and B together: the law of total variance.
void addTogether(PictureDifference& result) {
    double squares = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
        result.bias += result.channels[channel].bias / 3.0;
    }
    for (int channel = 0; channel < 3; ++channel) {
        const ErrorMoments& moments = result.channels[channel];
        squares += squared(moments.deviation) + squared(moments.bias - result.bias);
        result.max = std::max(result.max, moments.max);
    }
    result.deviation = std::sqrt(squares / 3.0);
}

} // namespace

glm::dvec3 labFromLinear(glm::dvec3 linear) {
    // IEC 61966-2-1; the white is the matrix's own, so that greys have no hue.
    const glm::dmat3 xyzFromLinear(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722,
                                   0.9505);
    const glm::dvec3 relative =
        (xyzFromLinear * linear) / (xyzFromLinear * glm::dvec3(1.0, 1.0, 1.0));
    const auto f = [](double t) {
        constexpr double kKnee = 6.0 / 29.0;
        return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
    };
    const double x = f(relative.x), y = f(relative.y), z = f(relative.z);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double deltaE2000(glm::dvec3 lab1, glm::dvec3 lab2) {
    const double meanChromaAb = (std::hypot(lab1.y, lab1.z) + std::hypot(lab2.y, lab2.z)) / 2.0;
    const double stretch = 1.0 + 0.5 * (1.0 - saturation(meanChromaAb)); // of a
    const double a1 = stretch * lab1.y, a2 = stretch * lab2.y;
    const double chroma1 = std::hypot(a1, lab1.z), chroma2 = std::hypot(a2, lab2.z);
    const HuePair hue =
        pairOf(hueDegrees(a1, lab1.z), hueDegrees(a2, lab2.z), chroma1 * chroma2 == 0.0);

    const double dL = lab2.x - lab1.x;
    const double dC = chroma2 - chroma1;
    const double dH = 2.0 * std::sqrt(chroma1 * chroma2) * sinDegrees(hue.difference / 2.0);
    const double meanL = (lab1.x + lab2.x) / 2.0;
    const double meanC = (chroma1 + chroma2) / 2.0;

    const double t = 1.0 - 0.17 * cosDegrees(hue.mean - 30.0) + 0.24 * cosDegrees(2.0 * hue.mean) +
                     0.32 * cosDegrees(3.0 * hue.mean + 6.0) -
                     0.20 * cosDegrees(4.0 * hue.mean - 63.0);
    const double fromMiddle = squared(meanL - 50.0);
    const double scaleL = 1.0 + 0.015 * fromMiddle / std::sqrt(20.0 + fromMiddle);
    const double scaleC = 1.0 + 0.045 * meanC;
    const double scaleH = 1.0 + 0.015 * meanC * t;
    const double turned = 30.0 * std::exp(-squared((hue.mean - 275.0) / 25.0)); // of the blues
    const double rotation = -sinDegrees(2.0 * turned) * 2.0 * saturation(meanC);

    const double l = dL / scaleL, c = dC / scaleC, h = dH / scaleH;
    // The rotation makes the form indefinite by no more than rounding.
    return std::sqrt(std::max(0.0, l * l + c * c + h * h + rotation * c * h));
}

PictureDifference difference(std::span<const glm::dvec4> picture,
                             std::span<const glm::dvec4> reference, CompositingSpace space) {
    SLABCAST_EXPECTS(!picture.empty() && picture.size() == reference.size(), picture.size());
    const auto labOf = [space](const glm::dvec4& pixel) {
        const glm::dvec3 color = glm::clamp(glm::dvec3(pixel), 0.0, 1.0);
        return labFromLinear(space == CompositingSpace::Linear ? color : linearFromSrgb(color));
    };
    std::vector<double> deltaE(picture.size());
    parallelFor(static_cast<std::int64_t>(picture.size()), kGrain,
                [&](std::int64_t begin, std::int64_t end) {
                    for (auto i = static_cast<std::size_t>(begin);
                         i < static_cast<std::size_t>(end); ++i) {
                        deltaE[i] = deltaE2000(labOf(picture[i]), labOf(reference[i]));
                    }
                });
    PictureDifference result;
    double squares = 0.0, sumDeltaE = 0.0;
    std::size_t visible = 0, visibleAlpha = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const glm::dvec4 apart = glm::abs(picture[i] - reference[i]);
        squares += glm::dot(glm::dvec3(apart), glm::dvec3(apart));
        visible += std::max({apart.x, apart.y, apart.z}) > kVisibleDifference ? 1 : 0;
        visibleAlpha += apart.w > kVisibleDifference ? 1 : 0;
        sumDeltaE += deltaE[i];
    }
    for (int channel = 0; channel < 4; ++channel) {
        result.channels[channel] = momentsOf(picture, reference, channel);
    }
    addTogether(result);
    const auto count = static_cast<double>(picture.size());
    result.rmse = std::sqrt(squares / (3.0 * count));
    result.psnr = result.rmse > 0.0 ? -20.0 * std::log10(result.rmse)
                                    : std::numeric_limits<double>::infinity();
    result.visibleShare = static_cast<double>(visible) / count;
    result.visibleAlphaShare = static_cast<double>(visibleAlpha) / count;
    result.meanDeltaE = sumDeltaE / count;
    // Nearest rank: the least value that 99.9 % of the pixels do not exceed.
    const auto rank = deltaE.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.999 * count)) - 1;
    std::nth_element(deltaE.begin(), rank, deltaE.end());
    result.p999DeltaE = *rank;
    return result;
}

} // namespace slabcast

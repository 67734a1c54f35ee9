#include "core/reference/flip.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/base/parallel.h"
#include "core/reference/picture_difference.h"

namespace slabcast {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kRowGrain = 8;

// Section numbers are the paper's.

/// Contrast sensitivity in space: a sum of two Gaussians a sqrt(pi/b) exp(-pi^2 x^2 / b), x in
/// degrees. Table 1: achromatic, red-green, blue-yellow.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivity[] = {
    {1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};

// 4.1.3 and 4.2: exponents, and where small differences end.
constexpr double kColorExponent = 0.7;
constexpr double kSmallShare = 0.4;     // of the largest colour difference ...
constexpr double kSmallMapped = 0.95;   // ... becomes this much of the result
constexpr double kFeatureWidth = 0.082; // degrees
constexpr double kFeatureExponent = 0.5;

/// Taps from -radius to radius.
using Taps = std::vector<double>;

int radiusOf(const Taps& taps) {
    return static_cast<int>(taps.size() / 2);
}

template <class Function>
Taps tapsOf(int radius, Function function) {
    Taps taps;
    for (int x = -radius; x <= radius; ++x) {
        taps.push_back(function(static_cast<double>(x)));
    }
    return taps;
}

/// Scaled so that positive taps sum to 1, and negative ones to -1.
Taps balanced(Taps taps) {
    double above = 0.0, below = 0.0;
    for (const double tap : taps) {
        (tap > 0.0 ? above : below) += std::abs(tap);
    }
    for (double& tap : taps) {
        tap /= tap > 0.0 ? above : std::max(below, 1e-300);
    }
    return taps;
}

/// A picture's rows or columns under taps; beyond the border its pixels go on.
template <class T>
std::vector<T> convolved(const std::vector<T>& picture, glm::ivec2 size, const Taps& taps,
                         bool alongRows) {
    const int radius = radiusOf(taps);
    const glm::ivec2 step = alongRows ? glm::ivec2(1, 0) : glm::ivec2(0, 1);
    std::vector<T> result(picture.size());
    const auto at = [&](glm::ivec2 place) -> const T& {
        const glm::ivec2 inside = glm::clamp(place, glm::ivec2(0), size - 1);
        return picture[static_cast<std::size_t>(inside.y) * size.x + inside.x];
    };
    parallelFor(size.y, kRowGrain, [&](std::int64_t begin, std::int64_t end) {
        for (auto y = static_cast<int>(begin); y < end; ++y) {
            for (int x = 0; x < size.x; ++x) {
                T sum(0.0);
                for (int k = -radius; k <= radius; ++k) {
                    sum += taps[static_cast<std::size_t>(k + radius)] *
                           at(glm::ivec2(x, y) + k * step);
                }
                result[static_cast<std::size_t>(y) * size.x + x] = sum;
            }
        }
    });
    return result;
}

template <class T>
std::vector<T> convolved(const std::vector<T>& picture, glm::ivec2 size, const Taps& along,
                         const Taps& across) {
    return convolved(convolved(picture, size, along, true), size, across, false);
}

// ---- colours

/// IEC 61966-2-1; relative to the matrix's own white, so that greys have no hue.
const glm::dmat3 kXyzFromLinear(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722,
                                0.9505);

/// Opponent colours that are linear in light: luminance, red against green, blue against yellow.
glm::dvec3 opponentFromLinear(glm::dvec3 linear) {
    const glm::dvec3 v = kXyzFromLinear * linear / (kXyzFromLinear * glm::dvec3(1.0));
    return {116.0 * v.y - 16.0, 500.0 * (v.x - v.y), 200.0 * (v.y - v.z)};
}

glm::dvec3 linearFromOpponent(glm::dvec3 opponent) {
    const double y = (opponent.x + 16.0) / 116.0;
    const glm::dvec3 relative(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
    return glm::inverse(kXyzFromLinear) * (relative * (kXyzFromLinear * glm::dvec3(1.0)));
}

/// 4.1.2: colours look less colourful in the dark.
glm::dvec3 huntAdjusted(glm::dvec3 lab) {
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

/// The distance that keeps large differences apart: city block in lightness, Euclidean in hue.
double hyab(glm::dvec3 lab1, glm::dvec3 lab2) {
    const glm::dvec3 d = lab1 - lab2;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

double poweredDistance(glm::dvec3 lab1, glm::dvec3 lab2) {
    return std::pow(hyab(lab1, lab2), kColorExponent);
}

/// 4.1.3: of the largest difference, green against blue, the smaller part is spread out.
double colorDifference(glm::dvec3 lab1, glm::dvec3 lab2) {
    static const double largest = poweredDistance(huntAdjusted(labFromLinear({0.0, 1.0, 0.0})),
                                                  huntAdjusted(labFromLinear({0.0, 0.0, 1.0})));
    const double small = kSmallShare * largest;
    const double apart = poweredDistance(lab1, lab2);
    const double mapped =
        apart < small ? kSmallMapped * apart / small
                      : kSmallMapped + (1.0 - kSmallMapped) * (apart - small) / (largest - small);
    return std::clamp(mapped, 0.0, 1.0);
}

/// 4.1.1: what is too fine for the eye from that far is blurred away, channel by channel.
std::vector<glm::dvec3> asSeen(const std::vector<glm::dvec3>& opponent, glm::ivec2 size,
                               double pixelsPerDegree) {
    double widest = 0.0;
    for (const Sensitivity& s : kSensitivity) {
        widest = std::max({widest, s.b1, s.b2});
    }
    const int radius =
        static_cast<int>(std::ceil(3.0 * std::sqrt(widest / (2.0 * kPi * kPi)) * pixelsPerDegree));
    std::vector<glm::dvec3> seen(opponent.size(), glm::dvec3(0.0));
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> values(opponent.size());
        std::transform(opponent.begin(), opponent.end(), values.begin(),
                       [channel](const glm::dvec3& pixel) { return pixel[channel]; });
        const Sensitivity& s = kSensitivity[channel];
        double total = 0.0;
        for (const auto& [a, b] : {std::pair(s.a1, s.b1), std::pair(s.a2, s.b2)}) {
            const Taps taps = tapsOf(radius, [&, b = b](double x) {
                return std::exp(-kPi * kPi * x * x / (pixelsPerDegree * pixelsPerDegree * b));
            });
            double sum = 0.0;
            for (const double tap : taps) {
                sum += tap;
            }
            const double scale = a * std::sqrt(kPi / b);
            if (scale == 0.0) {
                continue;
            }
            total += scale * sum * sum;
            const std::vector<double> blurred = convolved(values, size, taps, taps);
            for (std::size_t i = 0; i < seen.size(); ++i) {
                seen[i][channel] += scale * blurred[i];
            }
        }
        for (glm::dvec3& pixel : seen) {
            pixel[channel] /= total;
        }
    }
    return seen;
}

// ---- features

/// 4.2: first and second derivatives of a Gaussian tell edges and points, in luminance in [0, 1].
std::vector<glm::dvec2> featuresOf(const std::vector<glm::dvec3>& opponent, glm::ivec2 size,
                                   double pixelsPerDegree) {
    const double deviation = 0.5 * kFeatureWidth * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    const auto gaussian = [deviation](double x) {
        return std::exp(-x * x / (2.0 * deviation * deviation));
    };
    const Taps smooth = balanced(tapsOf(radius, gaussian));
    const Taps first = balanced(tapsOf(radius, [&](double x) { return -x * gaussian(x); }));
    const Taps second = balanced(tapsOf(
        radius, [&](double x) { return (x * x / (deviation * deviation) - 1.0) * gaussian(x); }));
    std::vector<double> luminance(opponent.size());
    std::transform(opponent.begin(), opponent.end(), luminance.begin(),
                   [](const glm::dvec3& pixel) { return (pixel.x + 16.0) / 116.0; });
    const auto magnitudes = [&](const Taps& derivative) {
        std::vector<double> along = convolved(luminance, size, derivative, smooth);
        const std::vector<double> across = convolved(luminance, size, smooth, derivative);
        std::transform(along.begin(), along.end(), across.begin(), along.begin(),
                       [](double x, double y) { return std::hypot(x, y); });
        return along;
    };
    const std::vector<double> edges = magnitudes(first);
    const std::vector<double> points = magnitudes(second);
    std::vector<glm::dvec2> features(opponent.size());
    for (std::size_t i = 0; i < features.size(); ++i) {
        features[i] = {edges[i], points[i]};
    }
    return features;
}

} // namespace

FlipPicture flipPicture(std::span<const glm::dvec4> picture, glm::ivec2 size,
                        CompositingSpace space, double pixelsPerDegree) {
    SLABCAST_EXPECTS(size.x > 0 && size.y > 0 &&
                         picture.size() == static_cast<std::size_t>(size.x) * size.y,
                     picture.size());
    SLABCAST_EXPECTS(pixelsPerDegree > 0.0, pixelsPerDegree);
    std::vector<glm::dvec3> opponent(picture.size());
    std::transform(picture.begin(), picture.end(), opponent.begin(), [space](const auto& pixel) {
        const glm::dvec3 color = glm::clamp(glm::dvec3(pixel), 0.0, 1.0);
        return opponentFromLinear(space == CompositingSpace::Linear ? color
                                                                    : linearFromSrgb(color));
    });
    FlipPicture made{size, asSeen(opponent, size, pixelsPerDegree),
                     featuresOf(opponent, size, pixelsPerDegree)};
    for (glm::dvec3& pixel : made.lab) {
        pixel = huntAdjusted(labFromLinear(glm::clamp(linearFromOpponent(pixel), 0.0, 1.0)));
    }
    return made;
}

std::vector<double> flip(const FlipPicture& picture, const FlipPicture& reference) {
    SLABCAST_EXPECTS(picture.size == reference.size, picture.size.x);
    std::vector<double> result(picture.lab.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const glm::dvec2 apart = glm::abs(picture.features[i] - reference.features[i]);
        const double feature =
            std::pow(std::max(apart.x, apart.y) / std::numbers::sqrt2, kFeatureExponent);
        result[i] = std::pow(colorDifference(picture.lab[i], reference.lab[i]),
                             1.0 - std::clamp(feature, 0.0, 1.0));
    }
    return result;
}

double flipOfColors(glm::dvec3 linear1, glm::dvec3 linear2) {
    return colorDifference(huntAdjusted(labFromLinear(linear1)),
                           huntAdjusted(labFromLinear(linear2)));
}

} // namespace slabcast

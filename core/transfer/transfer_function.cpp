#include "core/transfer/transfer_function.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace slabcast {
namespace {

constexpr std::array kSpaceNames{"display", "linear"};

bool inUnitRange(double value) {
    return value >= 0.0 && value <= 1.0;
} // false for NaN

bool inUnitRange(glm::dvec3 color) {
    return inUnitRange(color.x) && inUnitRange(color.y) && inUnitRange(color.z);
}

tl::unexpected<Error> invalid(const std::string& path, const std::string& remedy) {
    return fail(ErrorCode::InvalidTransferFunction, path + " " + remedy);
}

TransferSample sampleOf(const TransferPoint& point) {
    return {point.color, point.opacity};
}

// IEC 61966-2-1, one channel. Beyond [0,1] the curves go on, so that float targets keep highlights.

double linearFromSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

} // namespace

Result<TransferFunction> validated(TransferFunction tf) {
    if (!(tf.opacityUnitMm > 0.0) || !std::isfinite(tf.opacityUnitMm)) {
        return invalid("opacityUnitMm", "is not a positive length; give millimetres, such as 1.0");
    }
    if (tf.points.empty()) {
        return invalid("points", "is empty; give at least one point");
    }
    for (std::size_t i = 0; i < tf.points.size(); ++i) {
        TransferPoint& point = tf.points[i];
        const std::string path = "points[" + std::to_string(i) + "].";
        if (!(std::abs(point.value) <= double{std::numeric_limits<float>::max()})) {
            return invalid(path + "value", "is not a finite number; give a data value");
        }
        if (i > 0 && point.value < tf.points[i - 1].value) {
            return invalid(path + "value", "lies below the point before; sort points by value");
        }
        if (i > 1 && point.value == tf.points[i - 2].value) {
            return invalid(path + "value", "is there a third time; two points make a step");
        }
        if (!inUnitRange(point.color)) {
            return invalid(path + "color", "is not within 0 and 1; give sRGB components");
        }
        if (!inUnitRange(point.opacity)) {
            return invalid(path + "opacity", "is not within 0 and 1; give a fraction");
        }
        point.opacity = std::min(point.opacity, kMaxOpacity);
    }
    return tf;
}

TransferSample evaluate(const TransferFunction& tf, double value) {
    SLABCAST_EXPECTS(!tf.points.empty(), tf.points.size());
    const auto above =
        std::upper_bound(tf.points.begin(), tf.points.end(), value,
                         [](double v, const TransferPoint& point) { return v < point.value; });
    if (above == tf.points.begin()) {
        return sampleOf(tf.points.front());
    }
    const TransferPoint& below = *(above - 1);
    if (above == tf.points.end()) {
        return sampleOf(below);
    }
    const double t = (value - below.value) / (above->value - below.value);
    return {glm::mix(below.color, above->color, t), glm::mix(below.opacity, above->opacity, t)};
}

std::optional<ValueRange> visibleValues(const TransferFunction& tf) {
    constexpr double kNoEnd = std::numeric_limits<double>::infinity();
    const auto isVisible = [](const TransferPoint& point) { return point.opacity > 0.0; };
    const auto& points = tf.points;
    const auto first = std::find_if(points.begin(), points.end(), isVisible);
    if (first == points.end()) {
        return std::nullopt;
    }
    const auto last = std::find_if(points.rbegin(), points.rend(), isVisible);
    return ValueRange{first == points.begin() ? -kNoEnd : (first - 1)->value,
                      last == points.rbegin() ? kNoEnd : (last - 1)->value};
}

double extinctionPerMm(double opacity, double opacityUnitMm) {
    return -std::log1p(-opacity) / opacityUnitMm;
}

const char* name(CompositingSpace space) {
    const auto index = static_cast<std::size_t>(space);
    SLABCAST_EXPECTS(index < kSpaceNames.size(), index);
    return kSpaceNames[index];
}

glm::dvec3 linearFromSrgb(glm::dvec3 encoded) {
    return {linearFromSrgb(encoded.x), linearFromSrgb(encoded.y), linearFromSrgb(encoded.z)};
}

glm::dvec3 srgbFromLinear(glm::dvec3 linear) {
    return {srgbFromLinear(linear.x), srgbFromLinear(linear.y), srgbFromLinear(linear.z)};
}

glm::dvec3 colorIn(CompositingSpace space, glm::dvec3 encoded) {
    return space == CompositingSpace::Linear ? linearFromSrgb(encoded) : encoded;
}

} // namespace slabcast

#include "core/transfer/transfer_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace slabcast {

namespace {

constexpr double kFarValue = 1e300; // where the constant ends of a TF are taken to end

struct GaussNode {
    double place; // within [0, 1]
    double weight;
};

/// Gauss-Legendre, eight points on [0, 1].
constexpr std::array<GaussNode, 8> kGauss = {{
    {0.019855071751231884, 0.050614268145188130},
    {0.101666761293186630, 0.111190517226687235},
    {0.237233795041835507, 0.156853322938943644},
    {0.408282678752175098, 0.181341891689180991},
    {0.591717321247824902, 0.181341891689180991},
    {0.762766204958164493, 0.156853322938943644},
    {0.898333238706813370, 0.111190517226687235},
    {0.980144928248768116, 0.050614268145188130},
}};

/// Encoded values between which the curve of sRGB is a line, or a power of what at most doubles.
constexpr std::array kCurveCuts = {0.04045, 0.145, 0.345, 0.745};

TransferSample mix(const TransferSample& a, const TransferSample& b, double t) {
    return {glm::mix(a.color, b.color, t), glm::mix(a.opacity, b.opacity, t)};
}

/// Where within a segment, as a share of it, what runs from `first` to `last` takes a value.
void appendCrossing(std::vector<double>& shares, double first, double last, double value) {
    const double share = (value - first) / (last - first);
    if (share > 0.0 && share < 1.0) { // false where it is constant
        shares.push_back(share);
    }
}

} // namespace

TransferIntegral::TransferIntegral(const TransferFunction& tf, CompositingSpace space)
    : tf_(tf), space_(space) {
    SLABCAST_EXPECTS(!tf.points.empty(), tf.points.size());
    const TransferPoint& first = tf.points.front();
    const TransferPoint& last = tf.points.back();
    const TransferSample below{first.color, first.opacity};
    const TransferSample above{last.color, last.opacity};
    addPiece(-kFarValue, first.value, below, below);
    for (std::size_t i = 1; i < tf.points.size(); ++i) {
        addSegment(tf.points[i - 1], tf.points[i]);
    }
    addPiece(last.value, kFarValue, above, above);
}

void TransferIntegral::addSegment(const TransferPoint& left, const TransferPoint& right) {
    if (left.value == right.value) {
        return; // a step
    }
    const TransferSample first{left.color, left.opacity};
    const TransferSample last{right.color, right.opacity};
    std::vector<double> shares = {0.0, 1.0};
    for (double clear = 0.5; clear > 1.0 - kMaxOpacity; clear *= 0.5) { // -ln(1 - opacity)
        appendCrossing(shares, 1.0 - first.opacity, 1.0 - last.opacity, clear);
    }
    if (space_ == CompositingSpace::Linear) {
        for (int channel = 0; channel < 3; ++channel) {
            for (const double cut : kCurveCuts) {
                appendCrossing(shares, first.color[channel], last.color[channel], cut);
            }
        }
    }
    std::sort(shares.begin(), shares.end());
    double low = left.value;
    for (std::size_t k = 1; k < shares.size(); ++k) {
        const double high =
            k + 1 == shares.size() ? right.value : glm::mix(left.value, right.value, shares[k]);
        if (low < high) {
            addPiece(low, high, mix(first, last, shares[k - 1]), mix(first, last, shares[k]));
            low = high;
        }
    }
}

void TransferIntegral::addPiece(double low, double high, const TransferSample& atLow,
                                const TransferSample& atHigh) {
    pieces_.push_back({low, high, atLow, atHigh});
    pieces_.back().whole = between(pieces_.back(), low, high);
}

/// Extinction x colour, extinction.
glm::dvec4 TransferIntegral::material(const TransferSample& sample) const {
    return extinctionPerMm(sample.opacity, tf_.opacityUnitMm) *
           glm::dvec4(colorIn(space_, sample.color), 1.0);
}

glm::dvec4 TransferIntegral::between(const Piece& piece, double low, double high) const {
    if (piece.atLow.opacity == 0.0 && piece.atHigh.opacity == 0.0) {
        return glm::dvec4(0.0);
    }
    const double perValue = 1.0 / (piece.high - piece.low);
    glm::dvec4 sum(0.0);
    for (const GaussNode& node : kGauss) {
        const double share = (glm::mix(low, high, node.place) - piece.low) * perValue;
        sum += node.weight * material(mix(piece.atLow, piece.atHigh, share));
    }
    return sum * (high - low);
}

glm::dvec4 TransferIntegral::mean(double front, double back) const {
    const double low = std::min(front, back);
    const double high = std::max(front, back);
    if (low == high) {
        return material(evaluate(tf_, low));
    }
    auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), low,
                                  [](double value, const Piece& p) { return value < p.high; });
    glm::dvec4 sum(0.0);
    for (; piece != pieces_.end() && piece->low < high; ++piece) {
        const bool whole = low <= piece->low && piece->high <= high;
        sum += whole ? piece->whole
                     : between(*piece, std::max(low, piece->low), std::min(high, piece->high));
    }
    return sum / (high - low);
}

} // namespace slabcast

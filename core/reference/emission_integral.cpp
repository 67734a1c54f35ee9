#include "core/reference/emission_integral.h"

#include <algorithm>
#include <cmath>

#include "core/reference/gauss_kronrod.h"
#include "core/reference/material.h"

namespace slabcast {
namespace {

constexpr auto kNodes = GaussKronrod::kNodes;
using Values = GaussKronrod::Values;

/// Below, rounding would be taken for disagreement.
constexpr double kFinestTolerance = 1e-13;
/// Halvings of a stretch: enough for an optical depth of 2^90 before it.
constexpr int kMaxDepth = 96;
/// Of a stretch: tens where the field is smooth, hundreds before a logarithm's singularity. Where
/// more are asked for, it is by rounding: next to opacity 1 an extinction has ten digits.
constexpr std::int64_t kMaxEvaluations = 20'000;

double dot(const Values& a, const Values& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kNodes; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

double largest(glm::dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

/// Clamped, for the control points are rounded and the logarithm of the opacity's complement ends
/// at 1.
Values atNodes(const Cubic& cubic) {
    Values values;
    for (std::size_t i = 0; i < kNodes; ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            sum += cubic.points[k] * kGaussKronrod.bernstein[k][i];
        }
        values[i] = std::clamp(sum, 0.0, 1.0);
    }
    return values;
}

/// exp(-optical depth) in front of every node.
Values transmittanceAtNodes(const Values& depthPerNode) {
    Values depth{};
    for (std::size_t j = 0; j < kNodes; ++j) {
        for (std::size_t i = 0; i < kNodes; ++i) {
            depth[i] += depthPerNode[j] * kGaussKronrod.integralTo[j][i];
        }
    }
    for (double& value : depth) {
        value = std::exp(-value);
    }
    return depth;
}

} // namespace

struct EmissionIntegral::Estimate {
    double opticalDepth = 0.0;
    glm::dvec3 color{0.0}; // mean over d(alpha)
    double error = 0.0;    // of alpha and of premultiplied colour
};

EmissionIntegral::EmissionIntegral(double opacityUnitMm, CompositingSpace space, double tolerance)
    : opacityUnitMm_(opacityUnitMm), space_(space),
      tolerance_(std::max(tolerance, kFinestTolerance)) {}

void EmissionIntegral::add(const TransferRamp& ramp, const Cubic& share, double lengthMm) {
    if (ramp.isUniform()) {
        addUniform(ramp, lengthMm);
    } else {
        allowedError_ = 0.0;
        evaluationLimit_ = evaluations_ + kMaxEvaluations;
        addAdaptively(ramp, share, lengthMm, 0);
    }
}

void EmissionIntegral::addUniform(const TransferRamp& ramp, double lengthMm) {
    gather(colorIn(space_, ramp.low.color),
           extinctionPerMm(ramp.low.opacity, opacityUnitMm_) * lengthMm);
}

void EmissionIntegral::addAdaptively(const TransferRamp& ramp, const Cubic& share, double lengthMm,
                                     int depth) {
    if (isOpaque()) {
        return;
    }
    ++evaluations_;
    const Estimate found = estimate(ramp, share, lengthMm);
    // The first estimate is of the whole stretch, and sets what its parts are measured by.
    const double alpha = alpha_ - transmittance_ * std::expm1(-found.opticalDepth);
    allowedError_ = std::max(allowedError_, tolerance_ * alpha);
    if (transmittance_ * found.error <= allowedError_ || depth == kMaxDepth ||
        evaluations_ >= evaluationLimit_) {
        gather(found.color, found.opticalDepth);
        return;
    }
    for (const Cubic& half : share.halves()) {
        addAdaptively(ramp, half, 0.5 * lengthMm, depth + 1);
    }
}

EmissionIntegral::Estimate EmissionIntegral::estimate(const TransferRamp& ramp, const Cubic& share,
                                                      double lengthMm) const {
    const auto& weights = kGaussKronrod.weights;
    const auto& coarseWeights = kGaussKronrod.coarseWeights;
    const TransferSample& faint = ramp.faint();
    const TransferSample& dense = ramp.dense();
    const Values shares = atNodes(share);
    Values depths; // of the whole stretch, were the extinction everywhere that of the node
    for (std::size_t i = 0; i < kNodes; ++i) {
        const double opacity = glm::mix(faint.opacity, dense.opacity, shares[i]);
        depths[i] = extinctionPerMm(opacity, opacityUnitMm_) * lengthMm;
    }
    Estimate found;
    found.opticalDepth = dot(weights, depths);
    const double transmittance = std::exp(-found.opticalDepth);
    found.error = transmittance * std::abs(found.opticalDepth - dot(coarseWeights, depths));
    const double alpha = -std::expm1(-found.opticalDepth);
    if (faint.color == dense.color || alpha == 0.0) {
        found.color = colorIn(space_, faint.color);
        return found;
    }
    const Values transmittances = transmittanceAtNodes(depths);
    glm::dvec3 fine(0.0);
    glm::dvec3 coarse(0.0);
    double fineAlpha = 0.0;
    double coarseAlpha = 0.0;
    for (std::size_t i = 0; i < kNodes; ++i) {
        const double emission = depths[i] * transmittances[i];
        const glm::dvec3 color = colorIn(space_, glm::mix(faint.color, dense.color, shares[i]));
        fine += weights[i] * emission * color;
        coarse += coarseWeights[i] * emission * color;
        fineAlpha += weights[i] * emission;
        coarseAlpha += coarseWeights[i] * emission;
    }
    if (!(coarseAlpha > 0.0)) { // all of it lies before the first node
        found.color = colorIn(space_, glm::mix(faint.color, dense.color, share.points[0]));
        found.error += alpha;
        return found;
    }
    found.color = fine / fineAlpha;
    const glm::dvec3 change = glm::abs(dense.color - faint.color);
    found.error += alpha * largest(glm::abs(found.color - coarse / coarseAlpha)) +
                   largest(change) * std::abs(fineAlpha - alpha);
    return found;
}

void EmissionIntegral::gather(glm::dvec3 color, double opticalDepth) {
    color_ += color * (-transmittance_ * std::expm1(-opticalDepth));
    opticalDepth_ += opticalDepth;
    transmittance_ = std::exp(-opticalDepth_);
    alpha_ = -std::expm1(-opticalDepth_);
}

} // namespace slabcast

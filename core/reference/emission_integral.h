#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "core/reference/field_cubic.h"
#include "core/reference/transfer_ramps.h"

namespace slabcast {

/// The emission-absorption integral along one ray, gathered front to back from smooth stretches, in
/// each of which the value is a cubic and stays on one ramp of the TF:
///     colour = integral of c sigma exp(-tau),  alpha = 1 - exp(-tau),  tau = integral of sigma.
///
/// A stretch is halved until G7 and K15 agree on it. Optical depth at the nodes comes from
/// integrating the interpolant of sigma. Colour is the alpha of the stretch times the mean of c
/// over d(alpha): bounded however large sigma is, and exact where the colour is constant. So are
/// alpha and colour where sigma is 1e-12: nothing is formed as a difference from 1. That the sum of
/// d(alpha) must be the alpha tells when exp(-tau) falls too fast for the nodes; halving then finds
/// the front in as many steps as the depth has binary digits, and what lies behind is not looked
/// at.
class EmissionIntegral {
public:
    /// `tolerance`: of what the rules may differ by, which is far above the error of the finer one;
    /// relative to the alpha gathered by the end of the stretch.
    EmissionIntegral(double opacityUnitMm, CompositingSpace space, double tolerance);

    /// `share`: how far the value lies from the ramp's fainter end along the stretch, 0 to 1.
    void add(const TransferRamp& ramp, const Cubic& share, double lengthMm);

    /// The transmittance left is below the tolerance: nothing behind shows.
    bool isOpaque() const { return transmittance_ < tolerance_; }
    glm::dvec4 premultiplied() const { return {color_, alpha_}; }
    /// Of the pair of rules so far: what the ray cost.
    std::int64_t evaluations() const { return evaluations_; }

private:
    struct Estimate;

    void addUniform(const TransferRamp& ramp, double lengthMm);
    void addAdaptively(const TransferRamp& ramp, const Cubic& share, double lengthMm, int depth);
    Estimate estimate(const TransferRamp& ramp, const Cubic& share, double lengthMm) const;
    void gather(glm::dvec3 color, double opticalDepth);

    double opacityUnitMm_;
    CompositingSpace space_;
    double tolerance_;
    double allowedError_ = 0.0; // of each part of the present stretch
    std::int64_t evaluationLimit_ = 0;
    double opticalDepth_ = 0.0;
    double transmittance_ = 1.0;
    double alpha_ = 0.0;
    glm::dvec3 color_{0.0}; // premultiplied
    std::int64_t evaluations_ = 0;
};

} // namespace slabcast

#include "core/transfer/shading.h"

#include <algorithm>
#include <cmath>

namespace slabcast {

double shadingWeight(const ShadingParameters& parameters, double gradientPerMm) {
    const double floor = parameters.gradientFloorPerMm;
    if (floor <= 0.0) {
        return gradientPerMm > 0.0 ? 1.0 : 0.0;
    }
    const double t = std::clamp(gradientPerMm / floor - 1.0, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double diffuseLight(const ShadingParameters& parameters, double cosine) {
    return parameters.ambient + parameters.diffuse * std::abs(cosine);
}

} // namespace slabcast

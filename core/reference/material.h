#pragma once

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// Colour in the compositing space, not premultiplied, and extinction in 1/mm.
inline glm::dvec4 materialOf(const TransferFunction& tf, CompositingSpace space,
                             const TransferSample& sample) {
    const glm::dvec3 color =
        space == CompositingSpace::Linear ? linearFromSrgb(sample.color) : sample.color;
    return {color, extinctionPerMm(sample.opacity, tf.opacityUnitMm)};
}

inline glm::dvec4 materialOf(const TransferFunction& tf, CompositingSpace space, double value) {
    return materialOf(tf, space, evaluate(tf, value));
}

} // namespace slabcast

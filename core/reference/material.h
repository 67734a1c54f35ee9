#pragma once

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// Colour in the compositing space, not premultiplied, and extinction in 1/mm.
inline glm::dvec4 materialOf(const TransferFunction& tf, CompositingSpace space, double value) {
    const TransferSample sample = evaluate(tf, value);
    return {colorIn(space, sample.color), extinctionPerMm(sample.opacity, tf.opacityUnitMm)};
}

} // namespace slabcast

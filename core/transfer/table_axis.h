#pragma once

#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

namespace slabcast {

/// Where sampled values meet the table: texel = (sampled - firstSampled) * texelsPerSampled. In
/// this order, since values far from zero would lose the digits that tell them apart in a product
/// and a sum of float32. A table without a span reads its first texel for every value.
struct TableAxis {
    double firstSampled = 0.0;
    double texelsPerSampled = 0.0;
    int lastTexel = 0;
    bool hasSpan = false;

    double texelAt(double sampled) const { return (sampled - firstSampled) * texelsPerSampled; }
};

/// Contract: a positive scale of the texels, as encodeTexels() gives them.
/// Tested by: cell_visibility_test.cpp
TableAxis tableAxis(const Texels& texels, const TransferTable& table);

} // namespace slabcast

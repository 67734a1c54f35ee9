#pragma once

#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/type_precision.hpp>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// What a TF makes of an interval whose field runs linearly from one value to another, by both
/// values: its mean extinction, so that the opacity of any length h is 1 - exp(-mean * h), and
/// extinction times colour. Bilinear between texels; beyond the table's values the TF is constant.
/// Symmetric, since nothing within an interval darkens what is behind it; that is what its colour
/// is off by: see preintegratedColorError().
struct PreintegratedTable {
    /// Front and back alike: the axis of both, the unit of extinction, and which values are visible
    /// at all.
    TransferTable diagonal;
    /// Halfs, row by row, diagonal.texels.size() squared: (extinction x colour, extinction).
    std::vector<glm::u16vec4> texels;

    int size() const { return static_cast<int>(diagonal.texels.size()); }
    /// Texel in the table's unit.
    glm::vec4 at(int front, int back) const;
};

/// Largest edge that is built in a few milliseconds.
inline constexpr int kMaxPreintegratedSize = 512;

/// Exact means of the continuous TF between the values of its texels, rounded to fp16; where front
/// and back are alike makeTable()'s texel, which also keeps a peak between two texels. Another is
/// zero exactly where the TF is invisible between front and back; one that is not has a visible
/// texel of makeTable()'s between them, which is what skipping goes by.
/// Interpolation: where extinction curves over a texel, by c per value squared, a mean is off by up
/// to c/12 texels squared; next to a step, intervals of about a texel see a ramp.
/// Cost: O(maxSize^2), all cores. Tested by: preintegrated_test.cpp
PreintegratedTable makePreintegratedTable(const TransferFunction& tf, double dataMin,
                                          double dataMax, bool integerData, CompositingSpace space,
                                          int maxSize = kMaxPreintegratedSize);

/// Bilinear lookup of the table, as the shader does it, in float64: (extinction x colour,
/// extinction) in 1/mm.
glm::dvec4 lookUp(const PreintegratedTable& table, double front, double back);

/// How far the colour of an interval of optical depth D may be off, as a share of the range of
/// colours that it runs through. The table weighs them by extinction alone; what is at depth t
/// should count exp(-t) D / (1 - exp(-D)) times as much. Half of the mean difference of these
/// weights from 1: D/8 for small D, and never above D/8 or 1. A pixel is off by no more than its
/// worst interval, since the opacities of its intervals, as they are seen, add up to 1 at most.
double preintegratedColorError(double depth);

/// Largest difference of any channel between the colours of what a TF makes visible within
/// [dataMin, dataMax], in the compositing space.
double visibleColorRange(const TransferFunction& tf, double dataMin, double dataMax,
                         CompositingSpace space);

} // namespace slabcast

#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// How many pixels of a screen a degree of the viewer's sight holds: 67 as in the paper, 0.7 m from
/// a screen of 3840 pixels over 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0;

/// A picture as FLIP compares it: its colours as they look from that far, and its edges and points.
/// Rows as they came.
struct FlipPicture {
    glm::ivec2 size{0};
    std::vector<glm::dvec3> lab;      // filtered by contrast sensitivity, Hunt-adjusted
    std::vector<glm::dvec2> features; // how much of an edge, how much of a point
};

/// Premultiplied RGBA in a compositing space, so over black, of `size`; colours outside [0, 1] are
/// clamped. Beyond the border its pixels go on.
/// Cost: O(pixels * pixelsPerDegree), all cores: about 1 us a pixel of one core at 67.
FlipPicture flipPicture(std::span<const glm::dvec4> picture, glm::ivec2 size,
                        CompositingSpace space, double pixelsPerDegree = kPixelsPerDegree);

/// What a viewer who flips between two pictures sees of their difference, per pixel in [0, 1].
/// Contract: of one size. Symmetric; 0 of equal pictures.
/// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020, "FLIP: A
/// Difference Evaluator for Alternating Images" (LDR-FLIP). Tested by: flip_test.cpp
std::vector<double> flip(const FlipPicture& picture, const FlipPicture& reference);

/// The same of two colours that fill all that is seen (no feature tells them apart).
double flipOfColors(glm::dvec3 linear1, glm::dvec3 linear2);

} // namespace slabcast

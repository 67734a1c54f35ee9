#pragma once

#include <array>

#include <glm/glm.hpp>

namespace slabcast {

/// A cubic over [0, 1] in Bernstein form: it lies between its smallest and largest control point,
/// and is evaluated, cut and bounded by means alone, without cancellation.
struct Cubic {
    std::array<double, 4> points{};

    /// The polar form: multi-affine, symmetric, and the cubic itself where all three are equal.
    double blossom(double r, double s, double t) const;
    double at(double s) const { return blossom(s, s, s); }
    /// The part over [begin, end], as a cubic over [0, 1].
    Cubic part(double begin, double end) const;
    std::array<Cubic, 2> halves() const;
};

/// Where the cubic turns within (0, 1): ascending, two places at most.
struct Turns {
    int count = 0;
    std::array<double, 2> at{};
};
Turns turnsOf(const Cubic& cubic);

/// Where a cubic that is monotone over [begin, end] and has the value on either side (or at an end)
/// takes it, to rounding. Newton's method within a bracket that at least halves.
double crossingOf(const Cubic& cubic, double value, double begin, double end);

/// A trilinear field along a straight line through one cell: base + above. The base is kept apart
/// so that values that differ in their last bits keep the difference exactly.
struct FieldCubic {
    double base = 0.0;
    Cubic above;
};

/// `corners` around the cell, x fastest; `from` and `to` in the cell's coordinates. Exact where the
/// corners are equal.
FieldCubic fieldAlong(std::array<double, 8> corners, glm::dvec3 from, glm::dvec3 to);

} // namespace slabcast

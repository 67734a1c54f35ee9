#include "core/reference/field_cubic.h"

#include <cmath>
#include <utility>

namespace slabcast {
namespace {

/// Exact where both are equal.
double mixed(double a, double b, double share) {
    return a + share * (b - a);
}

double mean(double a, double b, double c) {
    return a + ((b - a) + (c - a)) / 3.0;
}

} // namespace

double Cubic::blossom(double r, double s, double t) const {
    const double a = mixed(points[0], points[1], r);
    const double b = mixed(points[1], points[2], r);
    const double c = mixed(points[2], points[3], r);
    return mixed(mixed(a, b, s), mixed(b, c, s), t);
}

Cubic Cubic::part(double begin, double end) const {
    return {{at(begin), blossom(begin, begin, end), blossom(begin, end, end), at(end)}};
}

std::array<Cubic, 2> Cubic::halves() const {
    const auto middle = [](double a, double b) { return 0.5 * (a + b); };
    const double a = middle(points[0], points[1]);
    const double b = middle(points[1], points[2]);
    const double c = middle(points[2], points[3]);
    const double ab = middle(a, b);
    const double bc = middle(b, c);
    const double centre = middle(ab, bc);
    return {Cubic{{points[0], a, ab, centre}}, Cubic{{centre, bc, c, points[3]}}};
}

Turns turnsOf(const Cubic& cubic) {
    // A third of the derivative's Bernstein form; a s^2 + 2 b s + c is the same in powers.
    const double c = cubic.points[1] - cubic.points[0];
    const double middle = cubic.points[2] - cubic.points[1];
    const double last = cubic.points[3] - cubic.points[2];
    if ((c >= 0.0 && middle >= 0.0 && last >= 0.0) || (c <= 0.0 && middle <= 0.0 && last <= 0.0)) {
        return {};
    }
    const double a = (c - middle) + (last - middle);
    const double b = middle - c;
    const double discriminant = b * b - a * c;
    if (discriminant <= 0.0) {
        return {};
    }
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    std::pair roots(q / a, c / q);
    if (roots.first > roots.second) {
        std::swap(roots.first, roots.second);
    }
    Turns turns;
    for (const double root : {roots.first, roots.second}) {
        if (root > 0.0 && root < 1.0) {
            turns.at[static_cast<std::size_t>(turns.count++)] = root;
        }
    }
    return turns;
}

double crossingOf(const Cubic& cubic, double value, double begin, double end) {
    const auto slopeAt = [&](double s) {
        const auto& p = cubic.points;
        const double a = mixed(p[1] - p[0], p[2] - p[1], s);
        const double b = mixed(p[2] - p[1], p[3] - p[2], s);
        return 3.0 * mixed(a, b, s);
    };
    const double first = cubic.at(begin) - value;
    const double last = cubic.at(end) - value;
    if (!(first * last < 0.0)) { // at an end, were it by rounding
        return std::abs(first) <= std::abs(last) ? begin : end;
    }
    double low = begin;
    double high = end;
    double s = mixed(begin, end, first / (first - last));
    double lastStep = high - low;
    for (;;) {
        const double excess = cubic.at(s) - value;
        (std::signbit(excess) == std::signbit(first) ? low : high) = s;
        double next = s - excess / slopeAt(s);
        const bool slow = std::abs(next - s) > 0.5 * lastStep;
        if (slow || !(next > low && next < high)) {
            next = mixed(low, high, 0.5);
        }
        if (excess == 0.0 || next == s || next <= low || next >= high) {
            return s;
        }
        lastStep = std::abs(next - s);
        s = next;
    }
}

FieldCubic fieldAlong(std::array<double, 8> corners, glm::dvec3 from, glm::dvec3 to) {
    const double base = corners[0];
    for (double& corner : corners) {
        corner -= base;
    }
    // Axis by axis: from the cell's corners to those of the box that the line is a diagonal of.
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t stride = std::size_t{1} << axis;
        for (std::size_t k = 0; k < 8; ++k) {
            if ((k & stride) == 0) {
                const double low = corners[k];
                const double high = corners[k + stride];
                corners[k] = mixed(low, high, from[axis]);
                corners[k + stride] = mixed(low, high, to[axis]);
            }
        }
    }
    // The trilinear function is the blossom of its cubic, but for symmetry.
    return {base,
            {{corners[0], mean(corners[1], corners[2], corners[4]),
              mean(corners[6], corners[5], corners[3]), corners[7]}}};
}

} // namespace slabcast

#include "perf/stability/manufactured_solution.h"

#include <algorithm>
#include <cmath>

#include "perf/stability/volumes.h"

namespace slabcast::stability::manufactured {

namespace {

constexpr double kOpacityUnitMm = 1.0;

// The greatest that derivatives are.
constexpr double kMostSlope = 6.0 * kDepth; // of sigma
constexpr double kSecond = 12.0 * kDepth;   // of sigma

double square(double value) {
    return value * value;
}

/// What a layer's error is made of, at a place: T, the steepest colour and its second derivative,
/// w = sigma T of a ray that leans and its slope.
struct Rates {
    double clear = 0.0;
    double color = 0.0;
    double color2 = 0.0;
    double w = 0.0;
    double w1 = 0.0;
};

Rates ratesAt(double s, double lean) {
    const double t = transmittance(s);
    const double sigma = extinction(s);
    const double slope = kMostSlope * (1.0 - 2.0 * s);
    const double clear = std::pow(t, lean);
    return {.clear = clear,
            .color = sigma * t * std::max(1.0, 2.0 * t), // of T and of T^2
            .color2 = t * std::max(std::abs(square(sigma) - slope),
                                   t * std::abs(4.0 * square(sigma) - 2.0 * slope)),
            .w = lean * sigma * clear,
            .w1 = lean * std::abs(slope - lean * square(sigma)) * clear};
}

/// Over parts of equal length, what `f` makes of the greatest of each rate in them.
template <class F>
double sumOfGreatest(int parts, double lean, const F& f) {
    constexpr int kPlaces = 8; // of a part that are looked at
    const double h = 1.0 / parts;
    double sum = 0.0;
    for (int i = 0; i < parts; ++i) {
        Rates most;
        for (int k = 0; k <= kPlaces; ++k) {
            const Rates found = ratesAt((i + double(k) / kPlaces) * h, lean);
            most = {std::max(most.clear, found.clear), std::max(most.color, found.color),
                    std::max(most.color2, found.color2), std::max(most.w, found.w),
                    std::max(most.w1, found.w1)};
        }
        sum += h * f(most);
    }
    return sum * (1.0 + square(kRate * h / kPlaces)); // what may lie between two places
}

} // namespace

double transmittance(double s) {
    return std::exp(-kDepth * s * s * (3.0 - 2.0 * s));
}

double extinction(double s) {
    return 6.0 * kDepth * s * (1.0 - s);
}

glm::dvec3 color(double s) {
    const double t = transmittance(s);
    return {1.0 - t, t, t * t};
}

glm::dvec4 solution(double lean) {
    // Of T^power, weighted by what the ray gathers: the integral of -T^power d(T^lean).
    const auto gathered = [&](double power) {
        return lean / (lean + power) * -std::expm1(-kDepth * (lean + power));
    };
    const double alpha = gathered(0.0);
    return {alpha - gathered(1.0), gathered(1.0), gathered(2.0), alpha};
}

double boundOfLayers(int layers, double lean) {
    const double h = 1.0 / layers;
    const double sum = sumOfGreatest(layers, lean, [&](const Rates& most) {
        return most.clear * lean * kSecond / 24.0 + most.color * most.w1 / 12.0 +
               most.color2 * most.w / 24.0;
    });
    // The samples' transmittance may be above T by as much as their depths are off.
    return h * h * sum * std::exp(lean * kSecond / 24.0 * h * h);
}

double boundOfKinks(double layers, double lean) {
    return 2.0 * lean * kMostSlope / 8.0 * square(1.0 / layers);
}

double boundOfKnots(int knots, double lean) {
    // Opacity 1 - exp(-u sigma): its second derivative is u (sigma'' - u sigma'^2) (1 - opacity).
    const double unit = kOpacityUnitMm / kThicknessMm;
    const double h = 1.0 / knots;
    const double sum = sumOfGreatest(knots, lean, [&](const Rates& most) {
        return most.clear * lean * (kSecond + unit * square(kMostSlope)) + most.color2 * most.w;
    });
    return h * h / 8.0 * sum * std::exp(unit * kMostSlope * h + lean * kSecond / 8.0 * h * h);
}

Volume volume() {
    return formulaVolume({24, 24, 17}, VoxelType::U16, [](glm::ivec3 v) { return 256.0 * v.z; });
}

TransferFunction transferFunction(int knots) {
    TransferFunction tf{.name = "manufactured", .opacityUnitMm = kOpacityUnitMm};
    for (int k = 0; k <= knots; ++k) {
        const double s = double(k) / knots;
        const double opacity = -std::expm1(-extinction(s) * kOpacityUnitMm / kThicknessMm);
        tf.points.push_back({kLastValue * s, color(s), opacity});
    }
    return tf;
}

View view(const Scene& scene, glm::ivec2 size) {
    constexpr double kRadiiAway = 2.5;
    constexpr double kHalfHeightMm = 6.0;
    const double awayMm = kRadiiAway * scene.geometry().boundingSphere().radiusMm;
    return orbitView(scene, {0.0, -90.0, kRadiiAway},
                     glm::degrees(2.0 * std::atan(kHalfHeightMm / awayMm)), size);
}

double leanOf(const View& view, glm::ivec2 size, glm::dvec2 fragCoord) {
    const glm::dvec2 share = fragCoord / glm::dvec2(size);
    const Frustum& f = view.frustum;
    return glm::length(
        glm::dvec3(glm::mix(f.left, f.right, share.x), glm::mix(f.bottom, f.top, share.y), 1.0));
}

double mostLean(const View& view, glm::ivec2 size) {
    return leanOf(view, size, glm::dvec2(0.5));
}

std::vector<glm::dvec4> solutionOf(const View& view, glm::ivec2 size) {
    std::vector<glm::dvec4> pixels;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            pixels.push_back(solution(leanOf(view, size, glm::dvec2(x, y) + 0.5)));
        }
    }
    return pixels;
}

} // namespace slabcast::stability::manufactured

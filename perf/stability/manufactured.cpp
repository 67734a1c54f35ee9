#include "perf/stability/manufactured_solution.h"

#include <algorithm>
#include <cmath>

#include "core/reference/continuous.h"
#include "core/reference/discrete.h"
#include "perf/stability/bench.h"

namespace slabcast::stability {

namespace {

using manufactured::kFamily;
using manufactured::kKnots;
constexpr glm::ivec2 kPixels(3, 3); // of float64's pictures

using Pixels = std::vector<glm::dvec4>;

double largestOf(glm::dvec4 v) {
    const glm::dvec4 size = glm::abs(v);
    return std::max({size.x, size.y, size.z, size.w});
}

double largestOf(const Pixels& a, const Pixels& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        worst = largerOf(worst, largestOf(a[i] - b[i]));
    }
    return worst;
}

/// Errors of a method by its number of steps, each with its bound where there is one.
struct Convergence {
    std::string name;
    const char* steps; // what is refined
    double order;
    std::string reason; // of the bounds
    struct Row {
        int steps;
        double error;
        double bound;
    };
    std::vector<Row> rows{};
};

const char* const kOrderReason =
    "the error's expansion goes on in powers of the step times 9, the greatest rate at which what "
    "is summed changes, so that the order is off by that power of the coarser step: the first for "
    "an order of 1, the second for one of 2";

/// A case per row; and one per pair of rows that is fine enough for the order to be seen.
void record(Bench& bench, const Convergence& found) {
    for (std::size_t i = 0; i < found.rows.size(); ++i) {
        const Convergence::Row& row = found.rows[i];
        const std::string many = std::to_string(row.steps) + " " + found.steps;
        bench.record({.family = kFamily,
                      .name = named({found.name, many}),
                      .quantity = "largest difference from the solution",
                      .bound = row.bound,
                      .reason = found.reason,
                      .measured = row.error,
                      .series = Series{.group = found.name,
                                       .panel = "",
                                       .x = double(row.steps),
                                       .y = row.error,
                                       .xLabel = "layers, or knots of the transfer function",
                                       .yLabel = "largest difference from the solution",
                                       .bound = row.bound}});
        const double power = found.order == 1.0 ? 1.0 : 2.0;
        const double next =
            i + 1 < found.rows.size() ? std::pow(manufactured::kRate / row.steps, power) : 1.0;
        if (next >= 0.25) {
            continue;
        }
        const double order = std::log2(row.error / found.rows[i + 1].error);
        bench.record({.family = kFamily,
                      .name = named({found.name, "order from " + many}),
                      .quantity = "difference of the order from " + number(found.order),
                      .bound = next,
                      .reason = kOrderReason,
                      .measured = std::abs(order - found.order)});
    }
}

// --- Functions alone ---

/// Sums layers of equal length through the slab, by the extinction in their middle, and by the
/// colour there or, wrongly, at their front; `exponential`: else opacity is the depth itself.
glm::dvec4 summed(int layers, double colorAt, bool exponential) {
    glm::dvec4 sum(0.0);
    for (int i = 0; i < layers; ++i) {
        const double depth = manufactured::extinction((i + 0.5) / layers) / layers;
        const double alpha = exponential ? -std::expm1(-depth) : depth;
        const glm::dvec3 color = manufactured::color((i + colorAt) / layers);
        sum += (1.0 - sum.a) * alpha * glm::dvec4(color, 1.0);
    }
    return sum;
}

struct Rule {
    const char* name;
    double colorAt; // of a layer: 0.5 is its middle
    bool exponential;
    double order;
    double first; // of the error by the step, at most
    const char* reason;
};
constexpr Rule kRules[] = {
    {"functions, middle of a layer", 0.5, true, 2.0, 0.0,
     "h^2 times the integral of T sigma''/24 + |c'| |w'|/12 + |c''| w/24, w = sigma T, by the "
     "greatest of each in a layer"},
    {"functions, wrong on purpose: colour of a layer's front", 0.0, true, 1.0,
     manufactured::kRate / 2.0,
     "h/2 |c'|, weighted by w, whose integral is 1 at most, beside what the middle errs by"},
    {"functions, wrong on purpose: opacity = depth", 0.5, false, 1.0,
     manufactured::kMostExtinction* manufactured::kDepth / 2.0,
     "depth^2/2 more of opacity in every layer: h/2 of sigma^2, beside what the middle errs by"}};

double boundOf(const Rule& rule, int layers) {
    return rule.first / layers + manufactured::boundOfLayers(layers, 1.0);
}

/// A mistake that the right rule's bound lets through would make that bound worthless.
void recordIsSeen(Bench& bench, const Convergence& wrong) {
    const auto unseen =
        std::count_if(wrong.rows.begin(), wrong.rows.end(), [](const Convergence::Row& row) {
            return !(row.error > manufactured::boundOfLayers(row.steps, 1.0));
        });
    bench.record({.family = kFamily,
                  .name = named({wrong.name, "is seen"}),
                  .quantity = "numbers of layers at which it keeps the right rule's bound",
                  .reason = "an error of order 1 is larger than what a rule of order 2 may err by",
                  .measured = double(unseen)});
}

void functionCases(Bench& bench) {
    for (const Rule& rule : kRules) {
        Convergence found{rule.name, "layers", rule.order, rule.reason};
        for (int layers = 8; layers <= 512; layers *= 2) {
            const glm::dvec4 off =
                summed(layers, rule.colorAt, rule.exponential) - manufactured::solution(1.0);
            found.rows.push_back({layers, largestOf(off), boundOf(rule, layers)});
        }
        record(bench, found);
        if (rule.order == 1.0) {
            recordIsSeen(bench, found);
        }
    }
}

// --- References ---

Result<Scene> sceneOf(Bench& bench, int knots) {
    return bench.scene(manufactured::volume(), {.tf = manufactured::transferFunction(knots)},
                       {.structure = SkipStructure::None}, true);
}

Pixels integralOf(const Scene& scene, const TransferFunction& tf, const View& view) {
    return renderContinuous({.texels = &scene.texels(),
                             .geometry = scene.geometry(),
                             .tf = tf,
                             .view = view,
                             .viewport = {0, 0, kPixels.x, kPixels.y},
                             .tolerance = 1e-13});
}

/// So many layers through the slab, which begin and end on its faces.
Pixels samplesOf(const Scene& scene, const DiscreteTransfer& transfer, const View& view,
                 int layers) {
    const double spacingMm = manufactured::kThicknessMm / layers;
    const int half = int(std::ceil(scene.geometry().boundingSphere().radiusMm / spacingMm));
    return renderDiscrete({.texels = &scene.texels(),
                           .geometry = scene.geometry(),
                           .transfer = transfer,
                           .view = view,
                           .viewport = {0, 0, kPixels.x, kPixels.y},
                           .lattice = {LatticeKind::Planar, 2 * half, spacingMm}});
}

void integralCases(Bench& bench, const Scene& scene, const View& view) {
    const double lean = manufactured::mostLean(view, kPixels);
    Convergence found{
        "integral, by knots", "knots", 2.0,
        "straight lines between knots for opacity and colour: h^2/8 of their second derivatives; "
        "and the integral's tolerance, 1e-13 for every piece"};
    for (int knots = 16; knots <= kKnots; knots *= 2) {
        const double error =
            largestOf(integralOf(scene, manufactured::transferFunction(knots), view),
                      manufactured::solutionOf(view, kPixels));
        found.rows.push_back(
            {knots, error, manufactured::boundOfKnots(knots, lean) + 1e-13 * knots});
    }
    record(bench, found);
}

/// Of quadratics the midpoint rule is off by h^2/24 times the slope's change, exactly: all that
/// alpha may be.
void recordSumsAlpha(Bench& bench, const Pixels& pixels, const View& view, int layers) {
    const double h = 1.0 / layers;
    double worst = 0.0;
    for (int i = 0; i < kPixels.x * kPixels.y; ++i) {
        const glm::dvec2 at = glm::dvec2(i % kPixels.x, i / kPixels.x) + 0.5;
        const double depth =
            manufactured::kDepth * (1.0 + h * h / 2.0) * manufactured::leanOf(view, kPixels, at);
        worst = largerOf(worst, std::abs(pixels[std::size_t(i)].a + std::expm1(-depth)));
    }
    bench.record({.family = kFamily,
                  .name = named({"samples, alpha as summed", std::to_string(layers) + " layers"}),
                  .quantity = "difference from 1 - exp(-3 (1 + h^2/2) lean)",
                  .bound = (6.0 * layers + 64.0) * 0x1p-53 + manufactured::kRate * 0x1p-49,
                  .reason = "the extinction is a quadratic of s, of which the midpoint rule gives "
                            "1 + h^2/2 times the depth, exactly; six roundings of 2^-53 a layer, "
                            "and places off by 2^-50, times the extinction's slope",
                  .measured = worst});
}

void sampleCases(Bench& bench, const Scene& scene, const View& view) {
    const double lean = manufactured::mostLean(view, kPixels);
    Convergence found{"samples", "layers", 2.0, kRules[0].reason};
    for (int layers = 8; layers <= kKnots / 2; layers *= 2) {
        const Pixels pixels = samplesOf(scene, scene.look().tf, view, layers);
        found.rows.push_back({layers, largestOf(pixels, manufactured::solutionOf(view, kPixels)),
                              manufactured::boundOfLayers(layers, lean)});
        recordSumsAlpha(bench, pixels, view, layers);
    }
    record(bench, found);
}

void preintegratedCases(Bench& bench, const Scene& scene, const View& view) {
    const double lean = manufactured::mostLean(view, kPixels);
    const Pixels integral = integralOf(scene, scene.look().tf, view);
    Convergence found{
        "pre-integrated samples, against the integral", "layers", 2.0,
        "extinction is the integral's, colour a mean by extinction alone: within a layer it is off "
        "by |c'| (sigma h)^2/12, weighted by w"};
    const double most = lean * manufactured::kMostExtinction;
    for (int layers = 8; layers <= 256; layers *= 2) {
        const Pixels pixels = samplesOf(scene, PreintegratedExact{scene.look().tf}, view, layers);
        double ofAlpha = 0.0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            ofAlpha = largerOf(ofAlpha, std::abs(pixels[i].a - integral[i].a));
        }
        bench.record(
            {.family = kFamily,
             .name = named({"pre-integrated samples, alpha", std::to_string(layers) + " layers"}),
             .quantity = "difference from the integral",
             .bound = 1e-11 * lean * manufactured::kDepth + 1e-13 * kKnots,
             .reason = "the value is linear along a ray, as pre-integration takes it to be: each "
                       "layer's depth is the integral's, by a rule that is right to 1e-11 of "
                       "itself; and the integral's tolerance, 1e-13 for every piece",
             .measured = ofAlpha});
        const double h = 1.0 / layers;
        found.rows.push_back({layers, largestOf(pixels, integral),
                              manufactured::kRate * most * h * h / 12.0 * std::exp(most * h)});
    }
    record(bench, found);
}

} // namespace

void manufacturedCases(Bench& bench) {
    functionCases(bench);
    const Result<Scene> scene = sceneOf(bench, kKnots);
    if (!scene) {
        return bench.recordFailure({.family = kFamily, .name = "medium"}, scene.error());
    }
    const View view = manufactured::view(*scene, kPixels);
    integralCases(bench, *scene, view);
    sampleCases(bench, *scene, view);
    preintegratedCases(bench, *scene, view);
    drawnManufacturedCases(bench, *scene);
}

} // namespace slabcast::stability

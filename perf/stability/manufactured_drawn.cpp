#include <cmath>

#include "perf/stability/exhibit.h"
#include "perf/stability/manufactured_solution.h"

namespace slabcast::stability {

namespace {

/// What a picture by this plan may be from the solution, but for blending. `table`: what rounds its
/// texels.
ExpectedPicture expectedOf(const Exhibit& exhibit, const FramePlan& plan, double table) {
    const double layers = manufactured::kThicknessMm / plan.lattice.spacingMm;
    const bool endOnFaces =
        plan.lattice.total % 2 == 0 && std::abs(std::remainder(layers, 2.0)) < 1e-9;
    const double lean = manufactured::mostLean(exhibit.view, exhibit.size);
    const auto texels = static_cast<int>(exhibit.scene.table().texels.size()) - 1;
    const double more = manufactured::boundOfLayers(int(std::lround(layers)), lean) +
                        (endOnFaces ? 0.0 : manufactured::boundOfKinks(layers, lean)) +
                        manufactured::boundOfKnots(manufactured::kKnots, lean) +
                        manufactured::boundOfKnots(texels, lean) + table;
    ExpectedPicture expected = expectedFromSamples(exhibit, plan);
    const std::vector<glm::dvec4> solution = manufactured::solutionOf(exhibit.view, exhibit.size);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        expected[i] = {solution[i], expected[i].bound + more, expected[i].atEdge};
    }
    return expected;
}

const std::string kDrawnReason =
    "the chosen solution; a pixel's own bound adds to what float32 and the target may do to its "
    "samples what layers err by (h^2 times second derivatives, and the kinks at both faces where "
    "layers do not end there), the knots of the transfer function, the texels of its table, and "
    "their rounding, ";

Exhibit exhibitOf(const Bench& bench, const Scene& scene, double layerSpacingVoxels) {
    const glm::ivec2 size(bench.reduced() ? 8 : 20);
    return {.family = manufactured::kFamily,
            .name = "drawn",
            .scene = scene,
            .view = manufactured::view(scene, size),
            .size = size,
            .layerSpacingVoxels = layerSpacingVoxels};
}

void drawnCases(Bench& bench, const Scene& scene) {
    const Exhibit exhibit = exhibitOf(bench, scene, 0.5);
    const Result<FramePlan> plan = bench.plan(scene, settingsFor(exhibit, methods().back()));
    if (!plan) {
        return bench.recordFailure({.family = manufactured::kFamily, .name = "drawn"},
                                   plan.error());
    }
    recordAgainst(bench, exhibit, kDrawnReason + "2^-11 of extinction and of colour",
                  expectedOf(exhibit, *plan, 0x1p-10));
}

/// So finely that little is left of the bound: 9 layers a voxel, which end on both faces, into
/// float32, from a table in float32, which a point beneath the data that is 12 decades fainter asks
/// for.
void drawnFinelyCase(Bench& bench) {
    Case c{.family = manufactured::kFamily,
           .name = named({"drawn, 9 layers a voxel", bench.finest().name}),
           .quantity = "worst share of a pixel's own bound",
           .bound = 1.0,
           .reason = kDrawnReason + "2^-24 of extinction and of colour"};
    TransferFunction tf = manufactured::transferFunction(manufactured::kKnots);
    tf.points.insert(tf.points.begin(), {-1.0, manufactured::color(0.0), 1e-13});
    const Result<Scene> scene =
        bench.scene(manufactured::volume(), {.tf = tf}, {.structure = SkipStructure::None}, true);
    if (!scene) {
        return bench.recordFailure(std::move(c), scene.error());
    }
    const Exhibit exhibit = exhibitOf(bench, *scene, 1.0 / 9.0);
    const Result<FramePlan> plan = bench.plan(*scene, settingsFor(exhibit, methods().back()));
    const Result<Picture> drawn = plan ? bench.drawFinely(*scene, *plan, exhibit.view, exhibit.size)
                                       : tl::unexpected(plan.error());
    if (!drawn) {
        return bench.recordFailure(std::move(c), drawn.error());
    }
    const ExpectedPicture expected = expectedOf(exhibit, *plan, 0x1p-23);
    c.measured = judge(exhibit, *drawn, expected,
                       std::vector<double>(expected.size(), bench.finest().rounding))
                     .share;
    bench.record(std::move(c));
}

} // namespace

void drawnManufacturedCases(Bench& bench, const Scene& scene) {
    drawnCases(bench, scene);
    drawnFinelyCase(bench);
}

} // namespace slabcast::stability

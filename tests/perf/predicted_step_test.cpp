#include "perf/error/predicted_step.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/formula_volume.h"

namespace slabcast {
namespace {

using test::floatTexels;
using test::tfOf;

/// A transfer function whose extinction is 1 + cos(k pi v / range) a mm, in enough points.
TransferFunction waveOf(int halfWaves, double range) {
    std::vector<TransferPoint> points;
    for (int i = 0; i <= 2000; ++i) {
        const double v = i / 2000.0;
        const double extinction = 1.0 + std::cos(halfWaves * M_PI * v);
        points.push_back({v * range, glm::dvec3(0.5), -std::expm1(-extinction)});
    }
    return tfOf(std::move(points));
}

/// Cosines are what it is told apart by: k half waves over the range are k / (2 range) a unit.
TEST(PredictedStep, OfAWaveTheFrequencyIsItsOwn) {
    for (const int halfWaves : {1, 2, 7, 20}) {
        for (const double range : {1.0, 250.0}) {
            EXPECT_NEAR(transferFrequency(waveOf(halfWaves, range), 0.0, range, 0.99),
                        halfWaves / (2.0 * range), 1e-12)
                << halfWaves;
        }
    }
}

/// Where extinction is the same everywhere, colour still makes waves.
TEST(PredictedStep, ColourHasAFrequencyOfItsOwn) {
    std::vector<TransferPoint> points;
    for (int i = 0; i <= 2000; ++i) {
        const double v = i / 2000.0;
        points.push_back({v, {0.5 + 0.5 * std::cos(6.0 * M_PI * v), 0.5, 0.5}, 0.3});
    }
    EXPECT_NEAR(transferFrequency(tfOf(std::move(points)), 0.0, 1.0, 0.99), 3.0, 1e-12);
}

TEST(PredictedStep, AConstantHasNone) {
    EXPECT_EQ(transferFrequency(tfOf({{.value = 0.0, .opacity = 0.3}}), 0.0, 1.0, 0.99), 0.0);
    EXPECT_EQ(transferFrequency(waveOf(3, 1.0), 1.0, 1.0, 0.99), 0.0);
    EXPECT_TRUE(std::isinf(StepPrediction{}.stepMm(5.0)));
}

/// The energy of a step's cosines falls as 1/k^2: a narrower share ends at fewer of them.
TEST(PredictedStep, AStepHasAsMuchAsTheShareAsksFor) {
    const TransferFunction step =
        tfOf({{.value = 0.5, .opacity = 0.0}, {.value = 0.5, .opacity = 0.5}});
    // Cosines 1, 3, 5, ... of energy 8 / (pi k)^2 of the whole: 0.81, 0.90, 0.93, ...
    EXPECT_NEAR(transferFrequency(step, 0.0, 1.0, 0.80), 0.5, 1e-12);
    EXPECT_NEAR(transferFrequency(step, 0.0, 1.0, 0.85), 1.5, 1e-12);
    EXPECT_NEAR(transferFrequency(step, 0.0, 1.0, 0.92), 2.5, 1e-12);
    EXPECT_GT(transferFrequency(step, 0.0, 1.0, 0.99), 8.0);
}

TEST(PredictedStep, GradientsAreOfMillimetresAndOfWhatIsVisible) {
    const VolumeGeometry geometry{.dims = {9, 6, 5}, .spacingMm = {0.5, 2.0, 1.0}};
    // 3 per voxel along x and 4 per voxel along y, but for a steep corner of low values.
    const Texels texels = floatTexels(geometry, [](glm::ivec3 v) {
        return v == glm::ivec3(0) ? -1000.0 : 3.0 * v.x + 4.0 * v.y;
    });
    const TransferFunction tf =
        tfOf({{.value = 10.0, .opacity = 0.0}, {.value = 20.0, .opacity = 0.5}});
    const FieldGradients g = gradientsOf(texels, geometry, tf);
    EXPECT_NEAR(g.greatest, std::hypot(3.0 / 0.5, 4.0 / 2.0), 1e-6);
    EXPECT_NEAR(g.percentile99, g.greatest, 1e-6);
    EXPECT_NEAR(g.anywhere, glm::length(glm::dvec3(1003.0 / 0.5, 1004.0 / 2.0, 1000.0)), 1e-2);
    EXPECT_EQ(gradientsOf(texels, geometry, tfOf({{.value = 0.0, .opacity = 0.0}})).greatest, 0.0);
}

/// Each corner of a cell has a slope of its own along each axis: the steepest is found at any.
TEST(PredictedStep, TheSteepestCornerOfACellIsFound) {
    const VolumeGeometry geometry{.dims = glm::ivec3(2), .spacingMm = {1.0, 2.0, 4.0}};
    const TransferFunction tf = tfOf({{.value = 0.0, .opacity = 0.5}});
    for (int peak = 0; peak < 8; ++peak) {
        const Texels texels = floatTexels(
            geometry, [peak](glm::ivec3 v) { return v.x + 2 * v.y + 4 * v.z == peak ? 8.0 : 0.0; });
        const double expected = glm::length(glm::dvec3(8.0, 4.0, 2.0));
        EXPECT_NEAR(gradientsOf(texels, geometry, tf).greatest, expected, 1e-6) << peak;
    }
    // Along an edge whose two corners are equal there is no slope.
    const Texels edge =
        floatTexels(geometry, [](glm::ivec3 v) { return v.y + v.z == 0 ? 8.0 : 0.0; });
    EXPECT_NEAR(gradientsOf(edge, geometry, tf).greatest, std::hypot(4.0, 2.0), 1e-6);
}

/// f of 3 cycles a unit along a gradient of 2 a mm is 6 cycles a mm: Nyquist asks for a twelfth.
TEST(PredictedStep, IsNyquistsOfFrequencyTimesGradient) {
    EXPECT_NEAR((StepPrediction{3.0, {}}.stepMm(2.0)), 1.0 / 12.0, 1e-15);
}

Json rowsOf(std::initializer_list<std::pair<double, double>> errors) {
    Json rows = Json::list();
    for (const auto& [spacing, rmse] : errors) {
        for (const bool jitter : {false, true}) {
            rows.push_back({{"classify", "post"},
                            {"jitter", jitter},
                            {"layer_spacing", spacing},
                            {"error", {{"sampling", {{"rmse", jitter ? 0.0 : rmse}}}}}});
        }
    }
    return rows;
}

TEST(PredictedStep, TheMeasuredOptimumIsTheCoarsestFromWhichOnAllAreGood) {
    const StepPrediction prediction{0.5, {.greatest = 1.0, .percentile99 = 0.5}}; // 1 mm; 2 mm
    // By chance good at 4 voxels already; 1/255 is 0.0039.
    const Json found = predictedStep(prediction, 2.0,
                                     rowsOf({{4.0, 1e-3}, {2.0, 0.01}, {1.0, 3e-3}, {0.5, 1e-3}}));
    EXPECT_EQ(found.at("measured_voxels").number(), 1.0);
    EXPECT_EQ(found.at("predicted_voxels").number(), 0.5);
    EXPECT_EQ(found.at("ratio").number(), 2.0);
    EXPECT_EQ(found.at("ratio_p99").number(), 1.0);
    EXPECT_NEAR(found.at("threshold_rmse").number(), 1.0 / 255.0, 1e-15);
    EXPECT_NE(found.at("why").text().find("within a factor of 2"), std::string::npos);
}

TEST(PredictedStep, SaysWhyPredictionAndMeasurementAreApart) {
    const StepPrediction prediction{0.5, {.greatest = 1.0, .percentile99 = 1.0}}; // 1 voxel
    const auto why = [&](const Json& rows) {
        return predictedStep(prediction, 1.0, rows).at("why").text();
    };
    const auto holds = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(holds(why(rowsOf({{8.0, 0.1}, {4.0, 1e-3}})), "a coarser step does"));
    EXPECT_FALSE(holds(why(rowsOf({{8.0, 0.1}, {4.0, 1e-3}})), "coarser ones may be too"));
    EXPECT_TRUE(holds(why(rowsOf({{4.0, 1e-3}})), "coarser ones may be too"));
    EXPECT_TRUE(holds(why(rowsOf({{1.0, 0.1}, {0.25, 1e-3}})), "a finer step is needed"));
    EXPECT_TRUE(holds(why(rowsOf({{1.0, 0.1}, {0.5, 0.02}})), "the finest, 0.5, has 0.02"));
    EXPECT_TRUE(holds(why(Json::list()), "nothing was measured"));
    EXPECT_TRUE(predictedStep(prediction, 1.0, Json::list()).at("measured_voxels").isNull());
}

} // namespace
} // namespace slabcast

#include "perf/error/convergence.h"

#include <cmath>

#include <gtest/gtest.h>

namespace slabcast {
namespace {

/// error = first * size^order, changes as of a method that converges to the truth.
std::vector<RefinementLevel> levelsOf(double order, int count = 5, double first = 0.1) {
    std::vector<RefinementLevel> levels;
    for (int k = 0; k < count; ++k) {
        const double size = std::exp2(-k);
        RefinementLevel level{size, first * std::pow(size, order)};
        if (k > 0) {
            level.change = levels.back().error - level.error;
        }
        levels.push_back(level);
    }
    return levels;
}

TEST(Convergence, AnOrderIsFoundAndAsymptotic) {
    for (const double order : {0.5, 1.0, 2.0, 3.0}) {
        const Convergence c = convergenceOf(levelsOf(order), 1e-12);
        EXPECT_TRUE(c.asymptotic) << c.why;
        EXPECT_NEAR(*c.order, order, 1e-12);
        EXPECT_NEAR(*c.selfOrder, order, 1e-12); // (1 - 2^-p) cancels
        EXPECT_FALSE(c.orders.front().has_value());
        EXPECT_TRUE(hasOrder(c, order));
        EXPECT_FALSE(hasOrder(c, order + 0.5));
        EXPECT_FALSE(hasOrder(c, order - 0.5));
    }
}

TEST(Convergence, SizesNeedNotHalve) {
    const Convergence c =
        convergenceOf(std::vector<RefinementLevel>{{9.0, 81.0}, {3.0, 9.0}, {1.0, 1.0}}, 0.0);
    EXPECT_NEAR(*c.order, 2.0, 1e-12);
    EXPECT_FALSE(c.asymptotic); // two refinements alone
}

TEST(Convergence, ThreeRefinementsAreNeeded) {
    EXPECT_FALSE(convergenceOf(levelsOf(2.0, 3), 1e-12).asymptotic);
    EXPECT_TRUE(convergenceOf(levelsOf(2.0, 4), 1e-12).asymptotic);
    EXPECT_FALSE(hasOrder(convergenceOf({}, 1e-12), 2.0));
}

/// Order 2 on average, but not of any one order: not asymptotic.
TEST(Convergence, AnUnsteadyOrderIsNoOrder) {
    std::vector<RefinementLevel> levels = levelsOf(2.0);
    levels[3].error *= std::exp2(0.25); // orders 2, 2, 1.75, 2.25
    const Convergence c = convergenceOf(levels, 1e-12);
    EXPECT_FALSE(c.asymptotic);
    EXPECT_NE(c.why.find("0.50"), std::string::npos) << c.why;
    EXPECT_FALSE(hasOrder(c, 2.0));
}

/// Levels before the asymptotic range do not count against those that are in it.
TEST(Convergence, ACoarseStartIsForgiven) {
    std::vector<RefinementLevel> levels = levelsOf(2.0, 6);
    levels[0].error *= 0.1;
    EXPECT_TRUE(hasOrder(convergenceOf(levels, 1e-12), 2.0));
}

TEST(Convergence, AtTheFloorThereIsNoOrder) {
    const std::vector<RefinementLevel> levels = levelsOf(2.0, 6, 0.1);
    const Convergence c = convergenceOf(levels, 1e-3); // 0.1, 0.025, 0.006, 0.0016 are above
    EXPECT_TRUE(c.asymptotic);
    EXPECT_FALSE(c.orders[4].has_value());
    const Convergence sooner = convergenceOf(levels, 1e-2);
    EXPECT_FALSE(sooner.asymptotic);
    EXPECT_NE(sooner.why.find("1 of the 3"), std::string::npos) << sooner.why;
    EXPECT_NE(sooner.why.find("0.01"), std::string::npos) << sooner.why;
}

/// What converges to something else has an order by its changes and none against the truth.
TEST(Convergence, AWrongLimitShowsInTheTwoOrders) {
    std::vector<RefinementLevel> levels = levelsOf(2.0, 6);
    for (RefinementLevel& level : levels) {
        level.error += 0.5;
    }
    const Convergence c = convergenceOf(levels, 1e-12);
    EXPECT_NEAR(*c.selfOrder, 2.0, 1e-9);
    EXPECT_TRUE(hasOrder(c, 0.0));
    EXPECT_FALSE(hasOrder(c, 2.0));
}

Json row(const char* classification, double spacing, double rmse, int layers = 0) {
    return {{"classify", classification},
            {"jitter", false},
            {"layer_spacing", spacing},
            {"layers_per_plane", layers},
            {"error", {{"sampling", {{"rmse", rmse}}}}}};
}

TEST(Convergence, FamiliesAreJudgedByWhatTheirClassificationPromises) {
    Json rows = Json::list();
    for (const double spacing : {0.25, 1.0, 2.0, 0.5}) { // in any order, once or twice
        rows.push_back(row("post", spacing, 0.01 * spacing));
        rows.push_back(row("post", spacing, 0.01 * spacing, 8));
        rows.push_back(row("preclassified", spacing, 0.04));
        rows.push_back(row("preintegrated", spacing, 0.01 * spacing * spacing));
    }
    const auto asExpected = [&rows](bool hasSteps) {
        std::string found;
        for (const Json& family : familyConvergence(rows, hasSteps)) {
            EXPECT_EQ(family.at("levels").size(), 4U);
            EXPECT_TRUE(family.at("asymptotic").flag());
            found += family.at("classify").text() +
                     (family.at("as_expected").flag() ? " right, " : " wrong, ");
        }
        return found;
    };
    EXPECT_EQ(asExpected(true), "post right, preclassified right, preintegrated right, ");
    EXPECT_EQ(asExpected(false), "post wrong, preclassified right, preintegrated right, ");
}

} // namespace
} // namespace slabcast

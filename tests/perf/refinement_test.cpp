#include "perf/error/refinement.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "core/reference/formula_ray.h"
#include "perf/error/refinement_scene.h"

namespace slabcast {
namespace {

/// Measured once for all tests.
const std::vector<RefinementStudy>& studies() {
    static const std::vector<RefinementStudy> made = refine();
    return made;
}

/// Each way that is right has the order that theory gives it, in its asymptotic range.
TEST(Refinement, WhatIsRightHasItsOrder) {
    std::set<std::string> kinds;
    for (const RefinementStudy& study : studies()) {
        if (!study.control) {
            kinds.insert(study.kind);
            EXPECT_EQ(study.expectedOrder, study.rightOrder) << study.method;
            EXPECT_TRUE(study.asExpected())
                << study.kind << " " << study.method << ": order "
                << study.convergence.order.value_or(-9.0) << ", " << study.convergence.why;
        }
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"grid", "pixel", "step"}));
}

/// Each mistake is found by the same judgement, and has the order that it leaves.
TEST(Refinement, NoNegativeControlLooksRight) {
    std::set<std::string> kinds;
    for (const RefinementStudy& study : studies()) {
        if (study.control) {
            kinds.insert(study.kind);
            EXPECT_LT(study.expectedOrder, study.rightOrder - 2.0 * kOrderTolerance);
            EXPECT_FALSE(study.looksRight()) << study.kind << " " << study.method;
            EXPECT_TRUE(study.asExpected())
                << study.kind << " " << study.method << ": order "
                << study.convergence.order.value_or(-9.0) << ", " << study.convergence.why;
        }
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"grid", "pixel", "step"}));
}

/// The truth that all is held against does not depend on how finely it is integrated.
TEST(Refinement, TheTruthIsExact) {
    const FormulaInput input = refinedInput();
    const VolumeGeometry cube = refinedCube(1);
    const RayFrame frame =
        makeRayFrame(refinedView(kRefinedFovDegrees), {0, 0, 9, 9}, cube,
                     {.total = 1, .spacingMm = 2.0 * cube.boundingSphere().radiusMm});
    double most = 0.0;
    for (int i = 0; i < 81; ++i) {
        const LatticeRay ray = rayAt(frame, glm::dvec2(i % 9, i / 9) + 0.5);
        const glm::dvec4 apart = glm::abs(integrateFormula(input, ray, kRefinedPieces) -
                                          integrateFormula(input, ray, 2 * kRefinedPieces));
        most = std::max({most, apart.x, apart.y, apart.z, apart.w});
    }
    EXPECT_LT(most, 1e-12);
}

TEST(Refinement, VoxelsAreTheFieldAtTheirCentres) {
    const Volume volume = refinedVolume(refinedInput().field, 4);
    const FormulaInput input = refinedInput();
    for (const glm::ivec3 v : {glm::ivec3(0), glm::ivec3(3, 1, 2)}) {
        const glm::dvec3 uvw = (glm::dvec3(v) + 0.5) / 4.0;
        EXPECT_NEAR(volume.valueAt(v), input.field(uvw), 1e-7);
        const glm::dvec4 place = volume.geometry.modelFromUvw() * glm::dvec4(uvw, 1.0);
        EXPECT_NEAR(place.x, kCubeMm * (uvw.x - 0.5), 1e-12);
    }
}

TEST(Refinement, TheTableHasALinePerLevel) {
    const std::string table = refinementCsv(studies());
    std::size_t levels = 0;
    for (const RefinementStudy& study : studies()) {
        levels += study.levels.size();
    }
    EXPECT_EQ(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')), levels + 1);
    const Json report = toJson(studies());
    EXPECT_EQ(report.at("studies").size(), studies().size());
    EXPECT_TRUE(report.at("studies").at(0).at("as_expected").flag());
}

} // namespace
} // namespace slabcast

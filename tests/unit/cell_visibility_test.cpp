#include "core/skip/cell_visibility.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/property.h"
#include "tests/support/skip_scene.h"

namespace slabcast {
namespace {

using test::anyElement;
using test::anyInt;
using test::anyInts;
using test::bandTable;
using test::constantScene;
using test::intsInRange;
using test::SkipScene;

/// The rule as the words have it: some texel with alpha between the cell's ends, one texel of grace
/// on each side; what lies outside the table reads its end texel. `slack` moves the ends apart, in
/// texels.
bool visibleByTheWords(const SkipScene& scene, int minCode, int maxCode, double error,
                       double slack) {
    const TransferTable& table = scene.table;
    const double last = double(table.texels.size()) - 1.0;
    const auto texelOf = [&](double sampled) {
        const double value = scene.texels.valueScale * sampled + scene.texels.valueBias;
        return (value - table.firstValue) / (table.lastValue - table.firstValue) * last;
    };
    const double one = texelOf(scene.codes.lowSampled[minCode] - error);
    const double other = texelOf(scene.codes.highSampled[maxCode] + error);
    const double from = std::clamp(std::floor(std::min(one, other) - slack) - 1.0, 0.0, last);
    const double to = std::clamp(std::ceil(std::max(one, other) + slack) + 1.0, 0.0, last);
    for (int k = 0; k < int(table.texels.size()); ++k) {
        if (table.texels[k].a > 0.0F && k >= from && k <= to) {
            return true;
        }
    }
    return false;
}

SkipScene randomTableScene() {
    SkipScene scene = constantScene(glm::ivec3(1), 0, {});
    const int size = anyInt(2, 40);
    scene.table = bandTable(size, 0, -1);
    for (const int k : anyInts(intsInRange(0, size))) {
        scene.table.texels[k].a = 0.25F;
    }
    scene.table.firstValue = anyInt(-400, 400) / 8.0;
    scene.table.lastValue = scene.table.firstValue + anyInt(1, 2000) / 8.0;
    scene.texels.valueScale = anyElement(1.0, 0.5, 2.0, 0.25);
    scene.texels.valueBias = anyInt(-400, 400) / 8.0;
    return scene;
}

PROPERTY(CellVisibility, SaysWhatTheWordsSay) {
    const SkipScene scene = randomTableScene();
    const double error = anyElement(0.0, 0.5, 3.0);
    const CellVisibility visibility = scene.visibility(error);
    for (int a = 0; a < 256; a += 3) {
        for (int b = a; b < 256; b += 5) {
            // Where an end falls on a texel, rounding may take either side.
            const bool visible = visibility.visible(std::uint16_t(a), std::uint16_t(b));
            PROPERTY_ASSERT(visible || !visibleByTheWords(scene, a, b, error, -1e-9));
            PROPERTY_ASSERT(!visible || visibleByTheWords(scene, a, b, error, 1e-9));
        }
    }
}

PROPERTY(CellVisibility, MissesNoValueThatACellCanTake) {
    const SkipScene scene = randomTableScene();
    const CellVisibility visibility = scene.visibility();
    const int a = anyInt(0, 256);
    const int b = anyInt(a, 256);
    for (int step = 0; step <= 1000; ++step) {
        const double sampled = a + (b - a) * step / 1000.0;
        const double value = scene.texels.valueScale * sampled + scene.texels.valueBias;
        if (lookUp(scene.table, value).a > 0.0) {
            PROPERTY_ASSERT(visibility.visible(std::uint16_t(a), std::uint16_t(b)));
        }
    }
}

TEST(CellVisibility, FindsTheBandBetweenTwoVoxelsThatTheVoxelRuleMisses) {
    SkipScene scene = constantScene({6, 1, 1}, 0, bandTable(256, 140, 160));
    for (int x = 0; x < 6; ++x) {
        scene.code({x, 0, 0}) = std::uint16_t(50 * x);
    }
    scene.code({3, 0, 0}) = 200; // 0 50 100 | 200 200 250: the band lies in one step
    for (int x = 0; x < 6; ++x) {
        ASSERT_EQ(lookUp(scene.table, scene.code({x, 0, 0})).a, 0.0) << "voxel " << x;
    }
    ASSERT_GT(lookUp(scene.table, test::fieldAt(scene, {3.0, 0.5, 0.5})).a, 0.0);
    const CellVisibility visibility = scene.visibility();
    for (int x = 0; x < 5; ++x) {
        EXPECT_EQ(visibility.visible(scene.code({x, 0, 0}), scene.code({x + 1, 0, 0})), x == 2);
    }
}

TEST(CellVisibility, WidensByOneTexelAndTheFilterError) {
    const SkipScene scene = constantScene({1, 1, 1}, 0, bandTable(256, 100, 100));
    const CellVisibility exact = scene.visibility();
    EXPECT_FALSE(exact.visible(90, 98));
    EXPECT_TRUE(exact.visible(90, 99));
    EXPECT_TRUE(exact.visible(101, 110));
    EXPECT_FALSE(exact.visible(102, 110));
    const CellVisibility coarse = scene.visibility(2.0);
    EXPECT_FALSE(coarse.visible(90, 96));
    EXPECT_TRUE(coarse.visible(90, 97));
    EXPECT_TRUE(coarse.visible(103, 110));
    EXPECT_FALSE(coarse.visible(104, 110));
}

// Air pressure in pascals, a table texel for a hundredth of a float32 step: what the shader
// interpolates between two voxels may come out beyond both.
TEST(CellVisibility, ReachesWhereFloat32MayStray) {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int strayed = 0;
    for (int k = 0; k < 3000; ++k) {
        SkipScene scene = constantScene({1, 1, 1}, 0, bandTable(4096, 0, -1));
        scene.table.firstValue = between(101302.0, 101303.0);
        scene.table.lastValue = scene.table.firstValue + 0.3;
        const float a = float(scene.table.firstValue + between(-0.05, 0.3));
        const float b = float(double(a) + between(-0.02, 0.02));
        scene.codes.lowSampled[0] = scene.codes.highSampled[0] = std::min(a, b);
        scene.codes.lowSampled[1] = scene.codes.highSampled[1] = std::max(a, b);
        const float t = float(between(0.0, 1.0));
        const float value = a * (1.0F - t) + b * t;
        strayed += value < std::min(a, b) || value > std::max(a, b);
        const float texelsPerValue = float(4095.0 / 0.3);
        const float at = (value - float(scene.table.firstValue)) * texelsPerValue;
        const int texel = std::clamp(int(std::floor(at)), 0, 4095);
        scene.table.texels[texel].a = 1.0F;
        EXPECT_TRUE(scene.visibility().visible(0, 1)) << k << ": texel " << texel;
    }
    EXPECT_GT(strayed, 0) << "no value beyond both voxels: nothing was put to the test";
}

TEST(CellVisibility, TakesTheWholeBinOfACode) {
    SkipScene scene = constantScene({1, 1, 1}, 0, bandTable(256, 100, 100));
    scene.codes.lowSampled[7] = 10.0F;
    scene.codes.highSampled[7] = 99.5F;
    EXPECT_TRUE(scene.visibility().visible(7, 7));
    scene.codes.highSampled[7] = 97.5F;
    EXPECT_FALSE(scene.visibility().visible(7, 7));
    scene.codes.highSampled[7] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(scene.visibility().visible(7, 7));
}

TEST(CellVisibility, DegenerateTablesAreVisibleWhereAnyTexelIs) {
    SkipScene scene = constantScene({1, 1, 1}, 9, bandTable(1, 0, 0));
    EXPECT_TRUE(scene.visibility().visible(0, 0));
    scene.table = bandTable(1, 0, -1);
    EXPECT_FALSE(scene.visibility().visible(0, 255));
    scene.table = bandTable(3, 2, 2);
    scene.table.lastValue = scene.table.firstValue;
    EXPECT_TRUE(scene.visibility().visible(0, 0));
    scene.table = bandTable(3, 0, -1);
    scene.table.lastValue = scene.table.firstValue;
    EXPECT_FALSE(scene.visibility().visible(0, 255));
}

TEST(CellVisibility, OfAlphaIsAnyCornerWithAlpha) {
    const SkipScene scene = constantScene({1, 1, 1}, 0, bandTable(1, 0, 0));
    const CellVisibility visibility = cellVisibilityOfAlpha(scene.codes);
    for (int a = 0; a < 256; ++a) {
        for (int b = a; b < 256; ++b) {
            ASSERT_EQ(visibility.visible(std::uint16_t(a), std::uint16_t(b)), a > 0 || b > 0);
        }
    }
}

TEST(CellVisibility, BreachedContractsAbort) {
    SkipScene scene = constantScene({1, 1, 1}, 0, {});
    EXPECT_DEATH(scene.visibility(), "findVisibility: expects");
    scene.table = bandTable(2, 0, 1);
    EXPECT_DEATH(scene.visibility(-1.0), "filterErrorSampled");
}

} // namespace
} // namespace slabcast

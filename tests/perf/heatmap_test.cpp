#include <gtest/gtest.h>

#include "core/transfer/transfer_function.h"
#include "perf/heatmap.h"
#include "perf/report_folder.h"
#include "perf/sweep/sweep.h"

namespace slabcast {

namespace {

/// CIELAB's L* of an sRGB colour (CIE 15; Y of IEC 61966-2-1).
double lightness(glm::vec3 color) {
    const glm::dvec3 light = linearFromSrgb(glm::dvec3(color));
    const double y = glm::dot(light, glm::dvec3(0.2126729, 0.7151522, 0.0721750));
    return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : 24389.0 / 27.0 * y;
}

} // namespace

TEST(Heatmap, LightnessGrowsInProportionToTheCost) {
    for (int k = 0; k <= 20; ++k) {
        EXPECT_NEAR(lightness(heatColor(k / 20.0)), 5.0 * k, 1.0) << k;
    }
    EXPECT_EQ(heatColor(-1.0), heatColor(0.0));
    EXPECT_EQ(heatColor(2.0), heatColor(1.0));
}

TEST(Heatmap, CostsAreSumsOfWork) {
    const PixelWork work{
        .layersEvaluated = 3.0F, .volumeFetches = 20.0F, .skipFetches = 5.0F, .stretches = 100.0F};
    EXPECT_EQ(costOf(work, HeatmapQuantity::Iterations), 103.0);
    EXPECT_EQ(costOf(work, HeatmapQuantity::Fetches), 25.0);
    EXPECT_EQ(costOf(work, HeatmapQuantity::Layers), 3.0);
}

TEST(Heatmap, TheLastColourIsOfTheMostTheLayersOrANumber) {
    const std::vector<double> costs{1.0, 7.0, 3.0};
    EXPECT_EQ(maximumOf({}, costs, 50), 7.0);
    EXPECT_EQ(maximumOf({.absolute = true}, costs, 50), 50.0);
    EXPECT_EQ(maximumOf({.maximum = 2.5}, costs, 50), 2.5);
    EXPECT_EQ(maximumOf({}, {0.0}, 50), 1.0) << "never nothing";
}

TEST(Heatmap, PixelsAboveTheScaleHaveTheirCostsColours) {
    const glm::ivec2 size(64, 48);
    std::vector<double> costs(static_cast<std::size_t>(size.x) * size.y, 2.0);
    const std::vector<glm::vec4> pixels = drawHeatmap(size, costs, HeatmapQuantity::Layers, 4.0);
    EXPECT_EQ(pixels.front(), glm::vec4(heatColor(0.5), 1.0F));
    EXPECT_NE(pixels.back(), pixels.front()) << "the scale is at the bottom";
}

TEST(Thumbnail, IsTheMeanOfWholeBlocks) {
    const glm::ivec2 size(400, 2); // shrunk to half
    std::vector<glm::vec4> picture(800, glm::vec4(0.0F));
    picture[0] = glm::vec4(1.0F);
    const ReportPicture small = thumbnail(size, picture);
    EXPECT_EQ(small.size, glm::ivec2(200, 1));
    ASSERT_EQ(small.pixels.size(), 200U);
    EXPECT_EQ(small.pixels[0], glm::vec4(0.25F));
    EXPECT_EQ(small.pixels[1], glm::vec4(0.0F));
}

TEST(Thumbnail, OfASmallPictureIsThePicture) {
    const std::vector<glm::vec4> picture(12, glm::vec4(0.5F));
    EXPECT_EQ(thumbnail({4, 3}, picture).size, glm::ivec2(4, 3));
    EXPECT_EQ(thumbnail({4, 3}, picture).pixels, picture);
}

TEST(Sweep, RowsAreThePlainStackAndWhatSkippingAndTightPlanesAdd) {
    SceneFacts facts;
    facts.sphere.radiusMm = 50.0;
    facts.skip.structure = SkipStructure::Proximity;
    const std::vector<SweepRow> rows = sweepRows({}, facts, {1, 16, 0, 4096});
    ASSERT_EQ(rows.size(), 12U);
    const int total = totalLayers({}, facts);
    EXPECT_EQ(rows[1].settings.layersPerPlane, 16);
    EXPECT_EQ(rows[2].settings.layersPerPlane, total) << "0 is ray casting";
    EXPECT_EQ(rows[3].settings.layersPerPlane, total) << "never more than there are";
    EXPECT_EQ(rows[0].settings.skip, SkipStructure::None);
    EXPECT_FALSE(rows[0].settings.tighten);
    EXPECT_EQ(rows[3].series, 0);
    EXPECT_EQ(rows[4].series, 1);
    EXPECT_EQ(rows[8].series, 2);
    EXPECT_EQ(rows[4].settings.skip, SkipStructure::Proximity);
    EXPECT_FALSE(rows[4].settings.tighten);
    EXPECT_EQ(rows[8].settings.skip, SkipStructure::Proximity);
    EXPECT_TRUE(rows[8].settings.tighten);
}

TEST(Sweep, WithoutSkippingTightPlanesAreAllThatIsAdded) {
    SceneFacts facts;
    facts.skip.structure = SkipStructure::Blocks; // what planes are tightened by
    Settings settings;
    settings.skip = SkipStructure::None;
    const std::vector<SweepRow> rows = sweepRows(settings, facts, {1});
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[1].settings.skip, SkipStructure::None);
    EXPECT_TRUE(rows[1].settings.tighten);
    settings.tighten = false;
    EXPECT_EQ(sweepRows(settings, facts, {1}).size(), 1U);
}

} // namespace slabcast

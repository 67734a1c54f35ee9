#include <set>

#include <gtest/gtest.h>

#include "perf/csv.h"
#include "perf/error/error_grid.h"
#include "perf/error/error_table_json.h"
#include "perf/json.h"

namespace slabcast {

namespace {

Json row(const Sampling& sampling, double total, double sampled, double ms) {
    Json made = toJson(sampling);
    made["id"] = idOf(sampling);
    made["error"] = {{"total", {{"rmse", total}}},
                     {"sampling", {{"rmse", sampled}}},
                     {"table", {{"rmse", 0.0}}},
                     {"gpu", nullptr}};
    made["frame_ms"] = {{"median", ms}};
    return made;
}

std::optional<double> timeOf(const Json& row) {
    return row.at("frame_ms").at("median").number();
}

MeasuredError measured(const char* volume, const char* commit, double rmse) {
    return {.scene = {volume, "bone", "0123"},
            .size = {160, 120},
            .sampling = {.layerSpacingVoxels = 0.1, .termination = 1.0 / 3.0, .jitter = true},
            .rmse = rmse,
            .msPerMegapixel = 12.5,
            .commit = commit};
}

} // namespace

TEST(ErrorGrid, AxesAreCompletedAndSorted) {
    const GridAxes axes = completed({.spacings = {0.5, 2.0}, .layersPerPlane = {8, 0, 1}}, false);
    EXPECT_EQ(axes.spacings, (std::vector{2.0, 0.5}));
    EXPECT_EQ(axes.layersPerPlane, (std::vector{0, 8, 1})); // ray casting first
    EXPECT_EQ(axes.classifications.size(), 3U);
    EXPECT_EQ(axes.targets.size(), 2U);
    EXPECT_LT(completed({}, true).spacings.size(), completed({}, false).spacings.size());
}

TEST(ErrorGrid, EveryCombinationHasAnIdOfItsOwn) {
    const GridAxes axes = completed({}, false);
    const std::vector<Sampling> grid = gridOf(axes, false);
    EXPECT_EQ(grid.size(), axes.spacings.size() * axes.layersPerPlane.size() *
                               axes.classifications.size() * axes.targets.size() *
                               axes.terminations.size() * axes.jitter.size());
    std::set<std::string> ids;
    for (const Sampling& sampling : grid) {
        ids.insert(idOf(sampling));
    }
    EXPECT_EQ(ids.size(), grid.size());
}

TEST(ErrorGrid, QuickVariesTerminationAndJitterOfRayCastingAlone) {
    const GridAxes axes = completed({}, true);
    for (const Sampling& s : gridOf(axes, true)) {
        const bool varied =
            s.jitter != axes.jitter.front() || s.termination != axes.terminations.front();
        EXPECT_TRUE(!varied || s.layersPerPlane == 0) << idOf(s);
    }
}

TEST(ErrorGrid, IdsNameTheSettings) {
    EXPECT_EQ(idOf({.layerSpacingVoxels = 0.5, .layersPerPlane = 8, .termination = 0.99609375}),
              "post_rgba8_s0.5_l8_t0.99609375");
    EXPECT_EQ(idOf({.target = TargetFormat::Rgba16f, .jitter = true}),
              "post_rgba16f_s1_l0_toff_jitter");
}

TEST(ErrorGrid, OrdersAreOfTheNextCoarserRowOfTheFamily) {
    Json rows = Json::list({row({.layerSpacingVoxels = 1.0}, 4e-2, 4e-2, 1.0),
                            row({.layerSpacingVoxels = 0.5}, 1e-2, 1e-2, 2.0),
                            row({.layerSpacingVoxels = 0.5, .jitter = true}, 1e-2, 1e-2, 2.0)});
    addOrders(rows);
    EXPECT_TRUE(rows[0].at("coarser").isNull());
    EXPECT_EQ(rows[1].at("coarser"), rows[0].at("id"));
    EXPECT_NEAR(rows[1].at("order").at("total").number(), 2.0, 1e-12);
    EXPECT_TRUE(rows[1].at("order").at("table").isNull()) << "at its floor";
    EXPECT_TRUE(rows[2].at("coarser").isNull()) << "another family";
}

TEST(ErrorGrid, TheFrontIsWhatNoOtherRowBeats) {
    const Json rows = Json::list({row({.layersPerPlane = 1}, 3e-2, 0.0, 5.0),
                                  row({.layersPerPlane = 2}, 4e-2, 0.0, 1.0),
                                  row({.layersPerPlane = 3}, 4e-2, 0.0, 6.0), // beaten in both
                                  row({.layersPerPlane = 4}, 1e-2, 0.0, 9.0)});
    EXPECT_EQ(frontOf(rows, timeOf), (std::vector<std::size_t>{1, 0, 3}));
    EXPECT_TRUE(frontOf(rows, [](const Json&) { return std::optional<double>(); }).empty());
}

TEST(Csv, ALinePerRow) {
    const Json rows = Json::list({{{"a", 1.5}, {"b", {{"c", "x,\"y\""}}}}, {{"a", nullptr}}});
    constexpr CsvColumn kColumns[] = {{"first", "/a"}, {"second", "/b/c"}};
    EXPECT_EQ(csvOf(rows, kColumns), "first,second\n1.5,\"x,\"\"y\"\"\"\n,\n");
}

TEST(ErrorTableJson, IsReadAsItWasWritten) {
    const std::vector<MeasuredError> table{measured("skull", "abc", 1e-3)};
    const Result<std::vector<MeasuredError>> read = parseErrorTable(errorTableText(table));
    ASSERT_TRUE(read) << read.error().detail;
    ASSERT_EQ(read->size(), 1U);
    EXPECT_EQ(read->front().scene, table.front().scene);
    EXPECT_EQ(read->front().size, table.front().size);
    EXPECT_EQ(read->front().sampling, table.front().sampling);
    EXPECT_EQ(read->front().rmse, table.front().rmse);
    EXPECT_EQ(read->front().msPerMegapixel, table.front().msPerMegapixel);
    EXPECT_EQ(read->front().commit, table.front().commit);
}

TEST(ErrorTableJson, WhatIsDamagedIsRefused) {
    const std::string text = errorTableText({measured("skull", "abc", 1e-3)});
    EXPECT_FALSE(parseErrorTable(""));
    EXPECT_FALSE(parseErrorTable(text.substr(0, text.size() / 2)));
    EXPECT_FALSE(parseErrorTable("{\"version\": 1, \"rows\": []}"));
    for (const char* key : {"volume", "space", "size", "layer_spacing", "layers_per_plane",
                            "classify", "target", "termination", "jitter", "rmse", "commit"}) {
        Json content = *Json::parse(text);
        content["rows"][0][key] = Json::object();
        const auto read = parseErrorTable(content.dump());
        ASSERT_FALSE(read) << key;
        EXPECT_EQ(read.error().code, ErrorCode::FileUnreadable);
        EXPECT_NE(read.error().detail.find(key), std::string::npos) << read.error().detail;
        content["rows"][0].erase(key);
        EXPECT_FALSE(parseErrorTable(content.dump())) << key;
    }
}

TEST(ErrorTableJson, FreshRowsReplaceTheirLikesAndThoseOfOtherBuilds) {
    const auto table = refreshed({measured("skull", "abc", 1.0), measured("foot", "abc", 2.0)},
                                 {measured("skull", "abc", 3.0)});
    ASSERT_EQ(table.size(), 2U);
    EXPECT_EQ(table[0].scene.volume, "foot");
    EXPECT_EQ(table[1].rmse, 3.0);
    EXPECT_EQ(refreshed(table, {measured("skull", "def", 4.0)}).size(), 1U);
}

} // namespace slabcast

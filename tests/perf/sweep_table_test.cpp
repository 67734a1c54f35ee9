#include "perf/sweep/sweep_table.h"

#include <gtest/gtest.h>

namespace slabcast {

namespace {

Json rowsOf(std::size_t count) {
    Json rows = Json::list();
    for (std::size_t k = 0; k < count; ++k) {
        rows.push_back(Json::object());
    }
    return rows;
}

} // namespace

TEST(SweepTable, RatiosArePairedWithSlicingAndWithThePlainStack) {
    // Plain slicing and ray casting, then both skipping; the second round is twice as slow for all.
    const SweepPlace places[] = {{0, 1}, {0, 64}, {1, 1}, {1, 64}};
    Json rows = rowsOf(4);
    addTimes(rows, places, {{8, 16, 8}, {4, 8, 4}, {16, 32, 16}, {2, 4, 2}});
    const Json& best = rows[3];
    EXPECT_EQ(best.at("speedup_over_slicing").number(), 8.0);
    EXPECT_EQ(best.at("speedup_over_plain").number(), 2.0);
    EXPECT_EQ(best.at("speedup_over_plain_slicing").number(), 4.0);
    EXPECT_EQ(best.at("speedup_over_plain_low").number(), 2.0);
    EXPECT_EQ(best.at("speedup_coverage").number(), 0.75);
    EXPECT_EQ(best.at("frame_ms").at("median").number(), 2.0);
    EXPECT_EQ(best.at("samples").size(), 3U);
    EXPECT_EQ(rows[2].at("speedup_over_plain_slicing").number(), 0.5);
}

TEST(SweepTable, WithoutSlicingThereIsNoRatioToIt) {
    const SweepPlace places[] = {{0, 16}, {1, 16}};
    Json rows = rowsOf(2);
    addTimes(rows, places, {{8, 8, 8}, {4, 4, 4}});
    EXPECT_FALSE(rows[1].contains("speedup_over_slicing"));
    EXPECT_EQ(rows[1].at("speedup_over_plain").number(), 2.0);
}

TEST(SweepTable, PercentilesAreThereFromNineRoundsOn) {
    const SweepPlace places[] = {{0, 1}};
    Json eight = rowsOf(1), nine = rowsOf(1);
    addTimes(eight, places, {{1, 2, 3, 4, 5, 6, 7, 8}});
    addTimes(nine, places, {{1, 2, 3, 4, 5, 6, 7, 8, 9}});
    EXPECT_TRUE(eight[0].at("frame_ms").at("p90").isNull());
    EXPECT_EQ(nine[0].at("frame_ms").at("p90").number(), 8.0);
}

} // namespace slabcast

#include <gtest/gtest.h>

#include "perf/frame_times.h"
#include "perf/number.h"
#include "perf/watcher.h"

namespace slabcast {

TEST(FrameTimes, SummariseAnyOrder) {
    const FrameTimes t = summarise({5.0, 1.0, 4.0, 2.0, 3.0});
    EXPECT_EQ(t.median, 3.0);
    EXPECT_EQ(t.min, 1.0);
    EXPECT_EQ(t.max, 5.0);
    EXPECT_EQ(t.p10, 1.0);
    EXPECT_EQ(t.p90, 5.0);
    EXPECT_EQ(t.count, 5);
}

TEST(FrameTimes, MedianOfAnEvenNumberIsBetweenTheMiddleTwo) {
    EXPECT_EQ(summarise({4.0, 1.0, 2.0, 8.0}).median, 3.0);
}

TEST(FrameTimes, PercentilesAreMeasuredTimes) {
    std::vector<double> times;
    for (int k = 0; k < 21; ++k) {
        times.push_back(k);
    }
    EXPECT_EQ(summarise(times).p10, 2.0);
    EXPECT_EQ(summarise(times).p90, 18.0);
}

TEST(FrameTimes, NothingOfNone) {
    EXPECT_EQ(summarise({}).count, 0);
    EXPECT_EQ(summarise({}).max, 0.0);
}

TEST(Number, AsPrintfWritesIt) {
    EXPECT_EQ(number(1.0 / 3.0), "0.333");
    EXPECT_EQ(number(1.2e-5), "1.2e-05");
    EXPECT_EQ(number(250.0), "250");
    EXPECT_EQ(fixed(0.99609375, 4), "0.9961");
    EXPECT_EQ(fixed(99.5, 0), "100");
}

TEST(ProgressLine, ShowsStepsAndThatTheyAreDone) {
    std::vector<std::string> shown;
    const Watcher watcher{.show = [&](const std::string& line) { shown.push_back(line); }};
    {
        ProgressLine line(watcher);
        EXPECT_TRUE(shown.empty());
        line.show("a");
        line.show("b");
    }
    EXPECT_EQ(shown, (std::vector<std::string>{"a", "b", ""}));
}

TEST(ProgressLine, IsSilentWhereNothingWasShownOrNobodyListens) {
    int heard = 0;
    const Watcher watcher{.show = [&](const std::string&) { ++heard; }};
    { const ProgressLine line(watcher); }
    EXPECT_EQ(heard, 0);
    const Watcher nobody;
    ProgressLine(nobody, "a").show("b");
}

} // namespace slabcast

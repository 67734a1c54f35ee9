#include "perf/paired_ratio.h"

#include <gtest/gtest.h>

namespace slabcast {

TEST(PairedRatio, IsTheMedianOfRoundsAndNotTheRatioOfMedians) {
    const double a[] = {1.0, 2.0, 9.0};
    const double b[] = {1.0, 8.0, 3.0};
    EXPECT_EQ(pairedRatio(a, b).median, 1.0); // of 1, 1/4 and 3; of the medians it would be 2/3
    const double even[] = {4.0, 2.0};
    const double ones[] = {1.0, 1.0};
    EXPECT_EQ(pairedRatio(even, ones).median, 3.0);
}

TEST(PairedRatio, DriftThatIsInBothIsInNeither) {
    const double quiet[] = {10.0, 10.0, 10.0};
    const double busy[] = {5.0, 15.0, 40.0};
    const double half[] = {2.5, 7.5, 20.0};
    EXPECT_EQ(pairedRatio(quiet, quiet).median, 1.0);
    EXPECT_EQ(pairedRatio(busy, half).median, 2.0);
    EXPECT_EQ(pairedRatio(busy, half).interval.low, 2.0);
    EXPECT_EQ(pairedRatio(busy, half).interval.high, 2.0);
}

TEST(PairedRatio, ItsIntervalIsOfTheRoundsRatios) {
    const double a[] = {1.0, 2.0, 9.0};
    const double b[] = {1.0, 8.0, 3.0};
    const PairedRatio ratio = pairedRatio(a, b);
    EXPECT_EQ(ratio.interval.low, 0.25);
    EXPECT_EQ(ratio.interval.high, 3.0);
    EXPECT_EQ(ratio.interval.coverage, 0.75);
}

} // namespace slabcast

#include "perf/median_interval.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slabcast {

namespace {

/// 1 to n, out of order.
std::vector<double> ranks(int n) {
    std::vector<double> samples;
    for (int k = n; k >= 1; --k) {
        samples.push_back(k);
    }
    return samples;
}

} // namespace

TEST(MedianInterval, IsOfTheRanksThatTablesGive) {
    // 1 - 2 (C(n,0) + ... + C(n,left)) / 2^n
    const struct {
        int n;
        double low, high, coverage;
    } cases[] = {{1, 1, 1, 0.0},
                 {3, 1, 3, 0.75},
                 {5, 1, 5, 0.9375},
                 {6, 1, 6, 1 - 2.0 / 64},
                 {8, 1, 8, 1 - 2.0 / 256},
                 {9, 2, 8, 1 - 2.0 * 10 / 512},
                 {12, 3, 10, 1 - 2.0 * 79 / 4096},
                 {20, 6, 15, 1 - 2.0 * 21700 / 1048576}};
    for (const auto& c : cases) {
        const MedianInterval interval = medianInterval(ranks(c.n));
        EXPECT_EQ(interval.low, c.low) << c.n;
        EXPECT_EQ(interval.high, c.high) << c.n;
        EXPECT_NEAR(interval.coverage, c.coverage, 1e-12) << c.n;
    }
}

TEST(MedianInterval, HoldsForMoreSamplesThanAPowerOfTwoCan) {
    const MedianInterval interval = medianInterval(ranks(5000));
    EXPECT_GE(interval.coverage, kMedianCoverage);
    EXPECT_LT(interval.coverage, kMedianCoverage + 0.002);
    // By the normal limit: n/2 -+ 1.96 sqrt(n)/2.
    EXPECT_NEAR(interval.low, 2500 - 0.98 * std::sqrt(5000.0), 2.0);
    EXPECT_EQ(interval.low + interval.high, 5001.0);
}

TEST(MedianInterval, CoversTheMedianOfASkewedDistributionAsOftenAsItSays) {
    std::mt19937 random(7);
    std::exponential_distribution<double> draw(1.0);
    constexpr int kTrials = 4000;
    int covered = 0;
    double said = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> samples(9);
        for (double& sample : samples) {
            sample = draw(random);
        }
        const MedianInterval interval = medianInterval(samples);
        said = interval.coverage;
        covered += interval.low <= std::log(2.0) && std::log(2.0) <= interval.high;
    }
    const double deviation = std::sqrt(said * (1.0 - said) / kTrials);
    EXPECT_NEAR(static_cast<double>(covered) / kTrials, said, 4.0 * deviation);
}

} // namespace slabcast

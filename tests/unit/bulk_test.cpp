#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/volume/phantoms.h"
#include "core/volume/statistics.h"
#include "tests/support/typed_volume.h"

namespace slabcast {
namespace {

using test::typeOf;

template <class T>
Volume rowOf(const std::vector<T>& voxels) {
    return test::volumeOf({static_cast<int>(voxels.size()), 1, 1}, voxels);
}

/// So many voxels from `low` to `high`, evenly.
template <class T>
std::vector<T> ramp(std::size_t count, double low, double high) {
    std::vector<T> voxels(count);
    for (std::size_t k = 0; k < count; ++k) {
        voxels[k] = static_cast<T>(low + (high - low) * static_cast<double>(k) /
                                             static_cast<double>(count - 1));
    }
    return voxels;
}

std::optional<BulkOfValues> bulkOf(const Volume& volume) {
    return computeStatistics(volume).bulk;
}

template <class T>
void expectOneHotVoxelLeftOut(double low, double high, double hot) {
    std::vector<T> voxels = ramp<T>(5000, low, high);
    voxels[77] = static_cast<T>(hot);
    const std::optional<BulkOfValues> bulk = bulkOf(rowOf(voxels));
    ASSERT_TRUE(bulk) << name(typeOf<T>());
    EXPECT_EQ(bulk->range.min, low);
    EXPECT_EQ(bulk->range.max, high);
    EXPECT_EQ(bulk->voxelsBelow, hot < low ? 1 : 0);
    EXPECT_EQ(bulk->voxelsAbove, hot > high ? 1 : 0);
    EXPECT_FALSE(bulk->fillBelow || bulk->fillAbove);
}

/// Voxels of 8 and 16 bits are counted by their value, floats are not.
template <class T>
void expectStatisticsOfFloats(const std::vector<T>& voxels, double slope) {
    Volume counted = rowOf(voxels);
    Volume single = rowOf(std::vector<float>(voxels.begin(), voxels.end()));
    counted.rescaleSlope = single.rescaleSlope = slope;
    const VolumeStatistics a = computeStatistics(counted);
    const VolumeStatistics b = computeStatistics(single);
    EXPECT_EQ(a.min, b.min);
    EXPECT_EQ(a.max, b.max);
    EXPECT_EQ(a.mean, b.mean); // sums of whole numbers below 2^53
    EXPECT_NEAR(a.standardDeviation, b.standardDeviation, 1e-9 * b.standardDeviation);
    EXPECT_EQ(a.histogram, b.histogram);
    ASSERT_EQ(a.bulk.has_value(), b.bulk.has_value());
    if (a.bulk) {
        EXPECT_EQ(a.bulk->range.min, b.bulk->range.min);
        EXPECT_EQ(a.bulk->range.max, b.bulk->range.max);
        EXPECT_EQ(a.bulk->voxelsBelow, b.bulk->voxelsBelow);
        EXPECT_EQ(a.bulk->voxelsAbove, b.bulk->voxelsAbove);
        EXPECT_EQ(a.bulk->fillBelow, b.bulk->fillBelow);
        EXPECT_EQ(a.bulk->fillAbove, b.bulk->fillAbove);
    }
}

TEST(Statistics, OfCountedValuesAreThoseOfVoxelsOneByOne) {
    constexpr std::size_t kCount = 300001; // more than are looked at one by one
    for (const double slope : {1.0, -0.5}) {
        expectStatisticsOfFloats(ramp<std::uint8_t>(kCount, 0, 255), slope);
        expectStatisticsOfFloats(ramp<std::int8_t>(kCount, -100, 90), slope);
        expectStatisticsOfFloats(ramp<std::uint16_t>(kCount, 300, 65535), slope);
        std::vector<std::int16_t> voxels = ramp<std::int16_t>(kCount, -1000, 2000);
        expectStatisticsOfFloats(voxels, slope);
        voxels[5] = 32767;
        std::fill(voxels.begin() + 1000, voxels.begin() + 3000, std::int16_t{-32768});
        expectStatisticsOfFloats(voxels, slope);
    }
}

TEST(Bulk, LeavesOneHotVoxelOutOfAnyType) {
    expectOneHotVoxelLeftOut<std::uint8_t>(0, 20, 255);
    expectOneHotVoxelLeftOut<std::int8_t>(-10, 10, -128);
    expectOneHotVoxelLeftOut<std::uint16_t>(0, 1000, 65535);
    expectOneHotVoxelLeftOut<std::int16_t>(0, 1000, 32767);
    expectOneHotVoxelLeftOut<std::int16_t>(20000, 20100, -32768);
    expectOneHotVoxelLeftOut<std::uint32_t>(0, 1000, 4294967295.0);
    expectOneHotVoxelLeftOut<std::int32_t>(16777216, 16777300, -2147483648.0);
    expectOneHotVoxelLeftOut<float>(0.0, 1.0, 1e6);
    expectOneHotVoxelLeftOut<float>(-1.0, 1.0, std::numeric_limits<float>::max());
    expectOneHotVoxelLeftOut<double>(1e6, 1e6 + 1.0, -1e30);
}

TEST(Bulk, LeavesAFewDifferentHotVoxelsOutAtBothEnds) {
    std::vector<std::int16_t> voxels = ramp<std::int16_t>(20000, -50, 50);
    for (std::int16_t k = 0; k < 5; ++k) {
        voxels[static_cast<std::size_t>(k) * 100] = static_cast<std::int16_t>(9000 + 500 * k);
        voxels[static_cast<std::size_t>(k) * 100 + 7] = static_cast<std::int16_t>(-9000 - 500 * k);
    }
    const std::optional<BulkOfValues> bulk = bulkOf(rowOf(voxels));
    ASSERT_TRUE(bulk);
    EXPECT_NEAR(bulk->range.min, -50.0, 1.0);
    EXPECT_NEAR(bulk->range.max, 50.0, 1.0);
    EXPECT_GE(bulk->voxelsBelow, 5);
    EXPECT_GE(bulk->voxelsAbove, 5);
    EXPECT_FALSE(bulk->fillBelow || bulk->fillAbove);
}

TEST(Bulk, TellsFillValuesAtBothEnds) {
    for (const double low : {-9999.0, 0.0}) {
        for (const double high : {9.96921e36, 1.0}) {
            std::vector<float> voxels = ramp<float>(4000, 0.0, 1.0);
            voxels.insert(voxels.end(), 3000, static_cast<float>(low));
            voxels.insert(voxels.end(), 2000, static_cast<float>(high));
            const std::optional<BulkOfValues> bulk = bulkOf(rowOf(voxels));
            ASSERT_EQ(bulk.has_value(), low < 0.0 || high > 1.0);
            if (bulk) {
                EXPECT_EQ(bulk->range.min, 0.0);
                EXPECT_EQ(bulk->range.max, 1.0);
                EXPECT_EQ(bulk->fillBelow, low < 0.0);
                EXPECT_EQ(bulk->fillAbove, high > 1.0);
                EXPECT_EQ(bulk->voxelsBelow, low < 0.0 ? 3000 : 0);
                EXPECT_EQ(bulk->voxelsAbove, high > 1.0 ? 2000 : 0);
            }
        }
    }
}

TEST(Bulk, IsOfDataValues) {
    std::vector<std::int16_t> voxels = ramp<std::int16_t>(4000, 0, 1000);
    voxels.insert(voxels.end(), 500, -32768);
    Volume volume = rowOf(voxels);
    volume.rescaleSlope = -0.5;
    volume.rescaleIntercept = 10.0;
    const VolumeStatistics s = computeStatistics(volume);
    ASSERT_TRUE(s.bulk);
    EXPECT_EQ(s.shown().min, -490.0);
    EXPECT_EQ(s.shown().max, 10.0);
    EXPECT_EQ(s.bulk->voxelsAbove, 500);
    EXPECT_TRUE(s.bulk->fillAbove);
    EXPECT_FALSE(s.bulk->fillBelow);
}

TEST(Bulk, IsNoneOfOrdinaryData) {
    EXPECT_FALSE(bulkOf(rowOf<std::int16_t>({-7})));
    EXPECT_FALSE(bulkOf(rowOf<float>({0.0F, 1e30F})));
    EXPECT_FALSE(bulkOf(rowOf<float>({0.0F, 1.0F, 1e30F})));
    EXPECT_FALSE(bulkOf(rowOf(std::vector<std::uint8_t>(5000, 7))));
    EXPECT_FALSE(bulkOf(rowOf(ramp<std::uint8_t>(5000, 0, 255))));
    EXPECT_FALSE(bulkOf(rowOf(ramp<float>(5000, -1e30, 1e30))));
    std::vector<std::uint8_t> allButOne(5000, 7);
    allButOne[3] = 200;
    EXPECT_FALSE(bulkOf(rowOf(allButOne)));
    std::vector<std::uint8_t> labels(5000, 0);
    for (std::size_t k = 0; k < labels.size(); ++k) {
        labels[k] = k % 9 < 8 ? static_cast<std::uint8_t>(k % 4) : std::uint8_t{200};
    }
    EXPECT_FALSE(bulkOf(rowOf(labels))) << "labels 0 to 3, and 200";
    const VolumeStatistics s = computeStatistics(rowOf(ramp<float>(5000, 2.0, 3.0)));
    EXPECT_EQ(s.shown().min, s.min);
    EXPECT_EQ(s.shown().max, s.max);
}

TEST(Bulk, IsNoneOfPhantoms) {
    for (const PhantomInfo& phantom : phantomList()) {
        for (const char* size : {":16", ":48"}) {
            const Result<Volume> volume =
                makePhantom("phantom:" + std::string(phantom.name) + size);
            ASSERT_TRUE(volume);
            EXPECT_FALSE(bulkOf(*volume)) << phantom.name << size;
        }
    }
}

TEST(Bulk, IsNotTakenForAir) {
    std::vector<std::int16_t> voxels = ramp<std::int16_t>(4000, 0, 1000);
    voxels.insert(voxels.end(), 500, -9999);
    const Volume volume = rowOf(voxels);
    EXPECT_EQ(likelyModality(volume, computeStatistics(volume)), Modality::Unknown);
}

} // namespace
} // namespace slabcast

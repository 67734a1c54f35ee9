#include "core/scene/texel_format.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

namespace slabcast {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::vector<TexelFormatTest> kAllFiltered = {{.format = TexelFormat::R8, .usable = true},
                                                   {.format = TexelFormat::R16, .usable = true},
                                                   {.format = TexelFormat::R16F, .usable = true}};
const std::vector<TexelFormatTest> kNoNorm16 = {{.format = TexelFormat::R16F, .usable = true}};

VolumeStatistics reaching(double min, double max, std::optional<ValueRange> bulk = {}) {
    VolumeStatistics statistics;
    statistics.min = min;
    statistics.max = max;
    if (bulk) {
        statistics.bulk = BulkOfValues{.range = *bulk};
    }
    return statistics;
}

/// Visible from `from` to `to`.
TransferFunction band(double from, double to) {
    return {.points = {{.value = from, .opacity = 0.0},
                       {.value = 0.5 * (from + to), .opacity = 0.5},
                       {.value = to, .opacity = 0.0}}};
}

TransferFunction ramp() {
    return {.points = {{.value = 0.25, .opacity = 0.0}, {.value = 0.75, .opacity = 1.0}}};
}

TEST(VisibleValuesTest, reachFromTheLastPointThatIsNotToTheNext) {
    const auto expectRange = [](const TransferFunction& tf, double min, double max) {
        const std::optional<ValueRange> visible = visibleValues(tf);
        ASSERT_TRUE(visible);
        EXPECT_EQ(visible->min, min);
        EXPECT_EQ(visible->max, max);
    };
    expectRange(band(2.0, 6.0), 2.0, 6.0);
    expectRange(ramp(), 0.25, kInfinity);
    expectRange({.points = {{.value = 1.0, .opacity = 1.0}, {.value = 2.0, .opacity = 0.0}}},
                -kInfinity, 2.0);
    EXPECT_FALSE(visibleValues({.points = {{.value = 1.0, .opacity = 0.0}}}));
    EXPECT_FALSE(visibleValues({}));
}

TEST(TexelStepTest, longestIsAQuarterOfTheBandOrA32ndOfTheBulk) {
    EXPECT_EQ(longestTexelStep(reaching(0.0, 64.0), ramp()), 2.0);
    EXPECT_EQ(longestTexelStep(reaching(0.0, 64.0), band(10.0, 14.0)), 1.0);
    EXPECT_EQ(longestTexelStep(reaching(0.0, 64e6, ValueRange{0.0, 32.0}), ramp()), 1.0);
    EXPECT_EQ(longestTexelStep(reaching(5.0, 5.0), ramp()), kInfinity);
    // Of no width: nothing that a sample between texels could meet.
    EXPECT_EQ(longestTexelStep(reaching(0.0, 64.0), band(3.0, 3.0)), 2.0);
}

/// Of texels that are made of such voxels; their rounding is held against it.
template <class T, std::size_t n>
double stepOf(const std::array<T, n>& values, VoxelType type, TexelFormat format) {
    Volume volume;
    volume.type = type;
    volume.geometry.dims = {static_cast<int>(n), 1, 1};
    volume.voxels = VoxelBytes(sizeof values);
    std::memcpy(volume.voxels.data(), values.data(), sizeof values);
    const VolumeStatistics statistics = computeStatistics(volume);
    const Texels texels = encodeTexels(volume, statistics, format);
    const double step = texelStep(format, type, statistics);
    EXPECT_LE(texels.maxQuantisationError, 0.5 * step * (1.0 + 1e-6));
    EXPECT_EQ(texels.maxQuantisationError == 0.0, step == 0.0);
    return step;
}

TEST(TexelStepTest, isWhatEncodedTexelsDifferBy) {
    constexpr std::array<float, 4> kFloats = {0.0F, 1.37F, 2.71F, 100.0F};
    EXPECT_DOUBLE_EQ(stepOf(kFloats, VoxelType::F32, TexelFormat::R16), 100.0 / 65535.0);
    EXPECT_DOUBLE_EQ(stepOf(kFloats, VoxelType::F32, TexelFormat::R16F), 100.0 / 4096.0);
    EXPECT_EQ(stepOf(kFloats, VoxelType::F32, TexelFormat::R32fExact), 0.0);
    constexpr std::array<std::int16_t, 4> kShorts = {-1000, 37, 38, 3071};
    EXPECT_EQ(stepOf(kShorts, VoxelType::I16, TexelFormat::R16), 0.0);
    EXPECT_EQ(stepOf(kShorts, VoxelType::I16, TexelFormat::R16F), 0.0);
    EXPECT_EQ(stepOf(kShorts, VoxelType::I16, TexelFormat::Rg8Exact), 0.0);
    constexpr std::array<std::int16_t, 4> kWide = {-32768, 38, 39, 32767};
    EXPECT_EQ(stepOf(kWide, VoxelType::I16, TexelFormat::R16), 0.0);
    EXPECT_DOUBLE_EQ(stepOf(kWide, VoxelType::I16, TexelFormat::R16F), 65535.0 / 4096.0);
}

TEST(ChooseTexelFormatTest, takesNoStepsThatAreTooLong) {
    std::string reason;
    const auto chosen = [&](VoxelType type, const VolumeStatistics& statistics, double longest,
                            const std::vector<TexelFormatTest>& tests) {
        return chooseTexelFormat(type, statistics, false, longest, tests, &reason);
    };
    const VolumeStatistics hot = reaching(0.0, 1e6);
    EXPECT_EQ(chosen(VoxelType::F32, hot, 16.0, kAllFiltered), TexelFormat::R16);
    EXPECT_EQ(chosen(VoxelType::F32, hot, 15.0, kAllFiltered), TexelFormat::R32fExact);
    EXPECT_NE(reason.find("r16 has steps of 15.3, too long for what is shown"), std::string::npos)
        << reason;
    const VolumeStatistics wide = reaching(-32768.0, 32767.0);
    EXPECT_EQ(chosen(VoxelType::I16, wide, 1e-3, kAllFiltered), TexelFormat::R16);
    EXPECT_EQ(chosen(VoxelType::I16, wide, 15.0, kNoNorm16), TexelFormat::Rg8Exact);
    EXPECT_EQ(chosen(VoxelType::I16, reaching(-1000.0, 3071.0), 1e-3, kNoNorm16),
              TexelFormat::R16F);
    EXPECT_EQ(chosen(VoxelType::U8, reaching(0.0, 255.0), 1e-3, kAllFiltered), TexelFormat::R8);
}

// A filter with weights of eight bits passes; one that lets a neighbour in, or is further off,
// fails.
TEST(TableFilterTest, isJudgedByZerosAndByWeights) {
    const FilterSample between{0.5, 0.5 + 1.0 / 300.0, 0.0, 1.0, 1};
    const FilterSample zero{0.0, 0.0, 0.0, 0.0, 1};
    const TableFilterTest good = judgeTableFilter(std::array{between, zero});
    EXPECT_TRUE(good.usable) << good.reason;
    EXPECT_NEAR(good.maxError, 1.0 / 300.0, 1e-12);
    FilterSample leaking = zero;
    leaking.measured = 1e-7;
    EXPECT_FALSE(judgeTableFilter(std::array{between, leaking}).usable);
    FilterSample coarse = between;
    coarse.measured = 0.5 + 1.0 / 200.0;
    EXPECT_FALSE(judgeTableFilter(std::array{coarse, zero}).usable);
    EXPECT_FALSE(judgeTableFilter({}).usable);
}

} // namespace
} // namespace slabcast

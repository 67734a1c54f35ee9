#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/volume/downsample.h"
#include "core/volume/statistics.h"
#include "core/volume/volume.h"
#include "core/volume/voxel_dispatch.h"
#include "tests/support/property.h"
#include "tests/support/typed_volume.h"

namespace slabcast {
namespace {

using test::anyInt;
using test::typeOf;
using test::volumeOf;

ErrorCode codeOf(const Volume& volume) {
    const Result<Volume> result = validated(volume);
    EXPECT_FALSE(result.has_value());
    return result ? ErrorCode::Internal : result.error().code;
}

VolumeGeometry obliqueGeometry() {
    VolumeGeometry geometry;
    geometry.dims = {4, 5, 6};
    geometry.spacingMm = {0.5, 1.25, 3.0};
    geometry.originMm = {-10.0, 20.0, 7.5};
    geometry.direction = glm::dmat3(glm::dvec3(0.6, 0.8, 0.0), glm::dvec3(-0.8, 0.6, 0.0),
                                    glm::dvec3(0.0, 0.0, -1.0));
    return geometry;
}

TEST(VolumeType, NamesAndSizes) {
    const struct {
        VoxelType type;
        const char* name;
        std::size_t bytes;
        bool floating;
    } expected[] = {{VoxelType::U8, "uint8", 1, false},   {VoxelType::I8, "int8", 1, false},
                    {VoxelType::U16, "uint16", 2, false}, {VoxelType::I16, "int16", 2, false},
                    {VoxelType::U32, "uint32", 4, false}, {VoxelType::I32, "int32", 4, false},
                    {VoxelType::F32, "float", 4, true},   {VoxelType::F64, "double", 8, true}};
    for (const auto& e : expected) {
        EXPECT_STREQ(name(e.type), e.name);
        EXPECT_EQ(bytesPerVoxel(e.type), e.bytes);
        EXPECT_EQ(isFloatingPoint(e.type), e.floating);
    }
}

TEST(VolumeGeometry, VoxelCentresLieWhereTheFileSays) {
    const VolumeGeometry geometry = obliqueGeometry();
    const glm::ivec3 voxel(3, 1, 5);
    const glm::dvec3 expected = geometry.originMm + geometry.direction[0] * (0.5 * voxel.x) +
                                geometry.direction[1] * (1.25 * voxel.y) +
                                geometry.direction[2] * (3.0 * voxel.z);
    const glm::dvec3 uvw = (glm::dvec3(voxel) + 0.5) / glm::dvec3(geometry.dims);
    const glm::dvec3 model(geometry.modelFromUvw() * glm::dvec4(uvw, 1.0));
    EXPECT_LT(glm::distance(model, expected), 1e-12);
    const glm::dvec3 back(geometry.uvwFromModel() * glm::dvec4(model, 1.0));
    EXPECT_LT(glm::distance(back, uvw), 1e-12);
}

TEST(VolumeGeometry, SmallestEdgeAndCount) {
    EXPECT_EQ(obliqueGeometry().smallestVoxelEdgeMm(), 0.5);
    VolumeGeometry large;
    large.dims = {2000, 2000, 2000};
    EXPECT_EQ(large.voxelCount(), 8'000'000'000);
}

TEST(VolumeGeometry, SphereOfABoxIsItsHalfDiagonal) {
    const BoundingSphere sphere = obliqueGeometry().boundingSphere();
    EXPECT_NEAR(sphere.radiusMm, 0.5 * std::sqrt(2.0 * 2.0 + 6.25 * 6.25 + 18.0 * 18.0), 1e-12);
}

TEST(VolumeGeometry, SphereHoldsAllCornersOfAShearedBox) {
    VolumeGeometry geometry;
    geometry.dims = {10, 10, 10};
    geometry.direction[1] = glm::normalize(glm::dvec3(1.0, 1.0, 0.0)); // gantry tilt, exaggerated
    const BoundingSphere sphere = geometry.boundingSphere();
    double farthest = 0.0;
    for (int c = 0; c < 8; ++c) {
        const glm::dvec3 steps(c & 1 ? 9.5 : -0.5, c & 2 ? 9.5 : -0.5, c & 4 ? 9.5 : -0.5);
        farthest = std::max(farthest, glm::distance(geometry.direction * steps, sphere.centreMm));
    }
    EXPECT_NEAR(sphere.radiusMm, farthest, 1e-12);
    EXPECT_GT(sphere.radiusMm, 0.5 * std::sqrt(300.0) + 0.1); // more than an upright box's
}

TEST(CheckedByteCount, MultipliesOrRefuses) {
    EXPECT_EQ(checkedByteCount({3, 5, 7}, VoxelType::F64).value(), 3 * 5 * 7 * 8);
    EXPECT_EQ(checkedByteCount({3, 0, 7}, VoxelType::U8).error().code, ErrorCode::EmptyVolume);
    EXPECT_EQ(checkedByteCount({3, 1, -7}, VoxelType::U8).error().code, ErrorCode::EmptyVolume);
    EXPECT_EQ(checkedByteCount({1LL << 31, 1, 1}, VoxelType::U8).error().code,
              ErrorCode::SizeOverflow); // no int32 index
    // 2^30 * 2^30 * 8 bytes is 2^63, one more than fits.
    EXPECT_EQ(checkedByteCount({1 << 30, 1 << 30, 1}, VoxelType::F64).error().code,
              ErrorCode::SizeOverflow);
    EXPECT_EQ(checkedByteCount({1 << 30, 1 << 30, 1}, VoxelType::F32).value(), 1LL << 62);
}

TEST(Validated, RefusesWhatIsNoVolume) {
    const Volume good = volumeOf<std::uint8_t>({2, 1, 1}, {1, 2});
    ASSERT_TRUE(validated(good).has_value());

    Volume bad = good;
    bad.geometry.dims.y = 0;
    EXPECT_EQ(codeOf(bad), ErrorCode::EmptyVolume);
    bad = good;
    bad.voxels.resize(bad.voxels.size() - 1);
    EXPECT_EQ(codeOf(bad), ErrorCode::FileTruncated);
    bad = good;
    bad.rescaleSlope = 0.0;
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidArgument);
    bad = good;
    bad.rescaleIntercept = std::nan("");
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidArgument);
    bad = good;
    bad.rescaleSlope = 1e38; // 255 of it are beyond float32
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidArgument);
    for (const double spacing :
         {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1.7e308}) {
        bad = good;
        bad.geometry.spacingMm.x = spacing;
        EXPECT_EQ(codeOf(bad), ErrorCode::InvalidGeometry) << spacing;
    }
    bad = good;
    bad.geometry.originMm.z = std::nan("");
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidGeometry);
    bad = good;
    bad.geometry.direction[2] = bad.geometry.direction[0];
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidGeometry);
    bad = good;
    bad.geometry.direction[1] = glm::dvec3(0.0);
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidGeometry);
    bad = good;
    bad.geometry.direction[1].x = std::nan("");
    EXPECT_EQ(codeOf(bad), ErrorCode::InvalidGeometry);
}

TEST(Validated, DropsTrailingBytesAndSharpensDirections) {
    Volume volume = volumeOf<std::uint8_t>({2, 1, 1}, {1, 2, 3});
    volume.geometry.direction[0] = {0.707, 0.707, 0.0}; // rounded in the file
    const Volume result = validated(volume).value();
    EXPECT_EQ(result.voxels.size(), 2U);
    EXPECT_NEAR(glm::length(result.geometry.direction[0]), 1.0, 1e-15);
}

template <class T>
void expectNonFiniteReplaced(double slope, T expected) {
    constexpr T kInf = std::numeric_limits<T>::infinity();
    Volume volume =
        volumeOf<T>({5, 1, 1}, {T{3}, kInf, -kInf, std::numeric_limits<T>::quiet_NaN(), T{-2}});
    volume.rescaleSlope = slope;
    const Volume result = validated(volume).value();
    EXPECT_EQ(result.nonFiniteVoxels, 3);
    visitVoxels(result, [&](auto voxels) {
        EXPECT_EQ(voxels[0], T{3});
        EXPECT_EQ(voxels[4], T{-2});
        for (const std::size_t i : {1U, 2U, 3U}) {
            EXPECT_EQ(voxels[i], expected);
        }
    });
}

TEST(Validated, ReplacesNonFiniteVoxelsByTheLowestDataValue) {
    expectNonFiniteReplaced<float>(2.0, -2.0F);
    expectNonFiniteReplaced<float>(-2.0, 3.0F); // the largest voxel is the lowest value
    expectNonFiniteReplaced<double>(1.0, -2.0);
}

TEST(Validated, AVolumeOfNothingButNanBecomesZero) {
    const float nan = std::nanf("");
    const Volume result = validated(volumeOf<float>({2, 1, 1}, {nan, nan})).value();
    EXPECT_EQ(result.nonFiniteVoxels, 2);
    EXPECT_EQ(result.valueAt({1, 0, 0}), 0.0);
}

TEST(Validated, DoublesBeyondFloatCountAsNonFinite) {
    const Volume result = validated(volumeOf<double>({2, 1, 1}, {1e300, 4.0})).value();
    EXPECT_EQ(result.nonFiniteVoxels, 1);
    EXPECT_EQ(result.valueAt({0, 0, 0}), 4.0);
}

TEST(Volume, ValueAtWalksXFirst) {
    std::vector<std::int16_t> voxels(2 * 3 * 4);
    std::iota(voxels.begin(), voxels.end(), std::int16_t{-5});
    Volume volume = volumeOf({2, 3, 4}, voxels);
    volume.rescaleSlope = -0.5;
    volume.rescaleIntercept = 10.0;
    EXPECT_EQ(volume.valueAt({1, 2, 3}), 10.0 - 0.5 * (-5 + 23));
    EXPECT_EQ(volume.valueAt({0, 1, 0}), 10.0 - 0.5 * (-5 + 2));
}

template <class T>
void expectExtremes() {
    using Limits = std::numeric_limits<T>;
    const Volume volume = volumeOf<T>({2, 1, 1}, {Limits::max(), Limits::lowest()});
    const VolumeStatistics s = computeStatistics(volume);
    EXPECT_EQ(s.min, static_cast<double>(Limits::lowest()));
    EXPECT_EQ(s.max, static_cast<double>(Limits::max()));
    EXPECT_EQ(s.histogram[0], 1);
    EXPECT_EQ(s.histogram[255], 1);
    EXPECT_DOUBLE_EQ(s.standardDeviation, 0.5 * (s.max - s.min));
}

TEST(Statistics, ReachTheEndsOfEveryType) {
    expectExtremes<std::uint8_t>();
    expectExtremes<std::int8_t>();
    expectExtremes<std::uint16_t>();
    expectExtremes<std::int16_t>();
    expectExtremes<std::uint32_t>();
    expectExtremes<std::int32_t>();
    expectExtremes<float>();
}

TEST(Statistics, OfOneVoxel) {
    const VolumeStatistics s = computeStatistics(volumeOf<std::int16_t>({1, 1, 1}, {-7}));
    EXPECT_EQ(s.min, -7.0);
    EXPECT_EQ(s.max, -7.0);
    EXPECT_EQ(s.mean, -7.0);
    EXPECT_EQ(s.standardDeviation, 0.0);
    EXPECT_EQ(s.histogram[0], 1);
}

TEST(Statistics, OfEveryByteOnce) {
    std::vector<std::uint8_t> voxels(256);
    std::iota(voxels.begin(), voxels.end(), std::uint8_t{0});
    const VolumeStatistics s = computeStatistics(volumeOf({16, 16, 1}, voxels));
    EXPECT_DOUBLE_EQ(s.mean, 127.5);
    EXPECT_DOUBLE_EQ(s.standardDeviation, std::sqrt((256.0 * 256.0 - 1.0) / 12.0));
    for (const std::int64_t count : s.histogram) {
        EXPECT_EQ(count, 1);
    }
}

TEST(Statistics, AgreeWithPlainLoopsAlsoAcrossRunsAndNegativeSlopes) {
    std::vector<std::int16_t> voxels(100 * 100 * 60); // more than two runs of voxels
    std::uint32_t state = 1;
    for (std::int16_t& voxel : voxels) {
        state = state * 1664525U + 1013904223U;
        voxel = static_cast<std::int16_t>(static_cast<int>(state >> 20) - 1024);
    }
    Volume volume = volumeOf({100, 100, 60}, voxels);
    volume.rescaleSlope = -0.25;
    volume.rescaleIntercept = 3.0;
    double sum = 0.0;
    double squares = 0.0;
    std::array<std::int64_t, 256> histogram{};
    const auto [least, most] = std::minmax_element(voxels.begin(), voxels.end());
    const double min = 3.0 - 0.25 * *most;
    const double max = 3.0 - 0.25 * *least;
    for (const std::int16_t voxel : voxels) {
        const double value = 3.0 - 0.25 * voxel;
        sum += value;
        squares += value * value;
        ++histogram[std::min(255UL, static_cast<std::size_t>((value - min) * 256.0 / (max - min)))];
    }
    const auto n = static_cast<double>(voxels.size());
    const VolumeStatistics s = computeStatistics(volume);
    EXPECT_EQ(s.min, min);
    EXPECT_EQ(s.max, max);
    EXPECT_NEAR(s.mean, sum / n, 1e-9);
    EXPECT_NEAR(s.standardDeviation, std::sqrt(squares / n - sum / n * sum / n), 1e-9);
    std::int64_t misplaced = 0; // values on a bin's very edge may fall to either side
    for (std::size_t bin = 0; bin < 256; ++bin) {
        misplaced += std::abs(s.histogram[bin] - histogram[bin]);
    }
    EXPECT_EQ(std::accumulate(s.histogram.begin(), s.histogram.end(), std::int64_t{0}),
              static_cast<std::int64_t>(voxels.size()));
    EXPECT_LT(misplaced, static_cast<std::int64_t>(voxels.size()) / 256);
}

TEST(LikelyModality, TrustsTheFileThenTheRange) {
    Volume volume;
    VolumeStatistics statistics;
    statistics.min = -1024.0;
    statistics.max = 3071.0;
    EXPECT_EQ(likelyModality(volume, statistics), Modality::Ct);
    volume.modality = Modality::Mr;
    EXPECT_EQ(likelyModality(volume, statistics), Modality::Mr);
    volume.modality = Modality::Unknown;
    statistics.min = -899.0;
    EXPECT_EQ(likelyModality(volume, statistics), Modality::Unknown);
    statistics = {.min = -1000.0, .max = -200.0};
    EXPECT_EQ(likelyModality(volume, statistics), Modality::Unknown);
}

TEST(Downsample, AveragesWholeBlocks) {
    std::vector<std::uint8_t> voxels(4 * 2 * 2);
    std::iota(voxels.begin(), voxels.end(), std::uint8_t{0});
    const Volume half = downsample(volumeOf({4, 2, 2}, voxels), glm::ivec3(2)).value();
    ASSERT_EQ(half.geometry.dims, glm::ivec3(2, 1, 1));
    // Voxels 0 1 4 5 8 9 12 13 average to 6.5, the others to 8.5: rounded away from zero.
    EXPECT_EQ(half.valueAt({0, 0, 0}), 7.0);
    EXPECT_EQ(half.valueAt({1, 0, 0}), 9.0);
    EXPECT_EQ(half.geometry.spacingMm, glm::dvec3(2.0));
    EXPECT_EQ(half.geometry.originMm, glm::dvec3(0.5));
}

TEST(Downsample, WeighsVoxelsThatAreCut) {
    // 5 voxels onto 3: each new voxel covers 5/3 of an old one.
    const Volume volume = volumeOf<float>({5, 1, 1}, {3.0F, 6.0F, 9.0F, 12.0F, 18.0F});
    const Volume result = downsample(volume, {2, 1, 1}).value();
    ASSERT_EQ(result.geometry.dims, glm::ivec3(3, 1, 1));
    EXPECT_FLOAT_EQ(static_cast<float>(result.valueAt({0, 0, 0})), (3.0F + 6.0F * 2 / 3) * 3 / 5);
    EXPECT_FLOAT_EQ(static_cast<float>(result.valueAt({1, 0, 0})),
                    (6.0F / 3 + 9.0F + 12.0F / 3) * 3 / 5);
    EXPECT_FLOAT_EQ(static_cast<float>(result.valueAt({2, 0, 0})), (12.0F * 2 / 3 + 18.0F) * 3 / 5);
}

PROPERTY(Downsample, KeepsBoxAndMean) {
    Volume volume;
    volume.type = VoxelType::F64;
    volume.geometry = obliqueGeometry();
    volume.geometry.dims = {anyInt(1, 12), anyInt(1, 12), anyInt(1, 12)};
    const glm::ivec3 factor(anyInt(1, 15), anyInt(1, 5), anyInt(1, 5));
    volume.voxels.resize(static_cast<std::size_t>(volume.geometry.voxelCount()) * 8);
    visitVoxels(volume, []<class T>(std::span<T> voxels) {
        for (T& voxel : voxels) {
            voxel = static_cast<T>(anyInt(-1000, 1000));
        }
    });
    const Volume result = downsample(volume, factor).value();
    const glm::dmat4 before = volume.geometry.modelFromUvw();
    const glm::dmat4 after = result.geometry.modelFromUvw();
    for (int column = 0; column < 4; ++column) {
        PROPERTY_ASSERT(glm::distance(before[column], after[column]) < 1e-9);
    }
    PROPERTY_ASSERT(std::abs(computeStatistics(volume).mean - computeStatistics(result).mean) <
                    1e-9);
}

TEST(Downsample, KeepsExtremesOfConstantVolumes) {
    const std::vector<std::uint32_t> most(27, std::numeric_limits<std::uint32_t>::max());
    EXPECT_EQ(downsample(volumeOf({3, 3, 3}, most), glm::ivec3(2)).value().valueAt({1, 1, 1}),
              4294967295.0);
    const std::vector<std::int16_t> least(27, -32768);
    EXPECT_EQ(downsample(volumeOf({3, 3, 3}, least), glm::ivec3(2)).value().valueAt({1, 1, 1}),
              -32768.0);
}

TEST(Downsample, RefusesFactorsBelowOne) {
    const Volume volume = volumeOf<std::uint8_t>({1, 1, 1}, {1});
    EXPECT_EQ(downsample(volume, {1, 0, 1}).error().code, ErrorCode::InvalidArgument);
}

TEST(VoxelBytes, AreTheirOwnOrSomebodyElses) {
    std::vector<std::byte> theirs = {std::byte{1}, std::byte{2}, std::byte{3}};
    int released = 0;
    {
        VoxelBytes adopted =
            VoxelBytes::adopted(theirs.data(), theirs.size(), [&](std::byte* bytes) {
                EXPECT_EQ(bytes, theirs.data());
                ++released;
            });
        const VoxelBytes copy = adopted;
        EXPECT_NE(copy.data(), theirs.data());
        EXPECT_EQ(copy, adopted);
        VoxelBytes moved = std::move(adopted);
        EXPECT_EQ(moved.data(), theirs.data());
        moved.resize(2);
        EXPECT_EQ(moved.data(), theirs.data()); // fewer keep their memory
        EXPECT_EQ(released, 0);
        moved.resize(4);
        EXPECT_EQ(released, 1);
        EXPECT_EQ(moved, (VoxelBytes{std::byte{1}, std::byte{2}, std::byte{0}, std::byte{0}}));
    }
    EXPECT_EQ(released, 1);
    EXPECT_TRUE(VoxelBytes().empty());
    EXPECT_EQ(VoxelBytes(3), (VoxelBytes{std::byte{0}, std::byte{0}, std::byte{0}}));
}

} // namespace
} // namespace slabcast

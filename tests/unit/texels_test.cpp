#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/volume/half.h"
#include "core/volume/texels.h"
#include "core/volume/voxel_dispatch.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyElement;
using test::anyInt;
using test::anyInt16sNotEmpty;
using test::checkProperty;

constexpr TexelFormat kAllFormats[] = {TexelFormat::R8, TexelFormat::R16, TexelFormat::R16F,
                                       TexelFormat::Rg8Exact, TexelFormat::R32fExact};

template <class T>
Volume volumeOf(VoxelType type, const std::vector<T>& voxels) {
    Volume volume;
    volume.type = type;
    volume.geometry.dims = {static_cast<int>(voxels.size()), 1, 1};
    volume.voxels.resize(voxels.size() * sizeof(T));
    std::memcpy(volume.voxels.data(), voxels.data(), volume.voxels.size());
    return volume;
}

Texels encoded(const Volume& volume, TexelFormat format) {
    return encodeTexels(volume, computeStatistics(volume), format);
}

/// The largest difference between what was stored and what is decoded, by a plain loop.
double measuredError(const Volume& volume, const Texels& texels) {
    double largest = 0.0;
    for (int x = 0; x < volume.geometry.dims.x; ++x) {
        largest = std::max(largest,
                           std::abs(volume.valueAt({x, 0, 0}) - decodedValue(texels, {x, 0, 0})));
    }
    return largest;
}

void expectExact(const Volume& volume, TexelFormat format) {
    const Texels texels = encoded(volume, format);
    const VolumeStatistics s = computeStatistics(volume);
    EXPECT_EQ(texels.maxQuantisationError, 0.0) << name(format);
    // Decoding runs in float64: what is left is its rounding.
    EXPECT_LE(measuredError(volume, texels), 1e-14 * (std::abs(s.min) + std::abs(s.max)))
        << name(format);
    EXPECT_GT(texels.valueScale, 0.0);
}

/// What a shader reads, by the definition in the header and the GL specification.
double sampledByDefinition(const Texels& texels, std::size_t i) {
    const std::byte* at = texels.data.data() + i * bytesPerTexel(texels.format);
    std::uint16_t word = 0;
    float real = 0.0F;
    switch (texels.format) {
    case TexelFormat::R8:
        return std::to_integer<int>(*at) / 255.0;
    case TexelFormat::R16:
        std::memcpy(&word, at, 2);
        return word / 65535.0;
    case TexelFormat::R16F:
        std::memcpy(&word, at, 2);
        return static_cast<double>(floatFromHalf(word));
    case TexelFormat::Rg8Exact:
        return std::to_integer<int>(at[0]) * 256 + std::to_integer<int>(at[1]);
    case TexelFormat::R32fExact:
        std::memcpy(&real, at, 4);
        return static_cast<double>(real);
    }
    return 0.0;
}

/// From the definition of binary16: sign, five bits of exponent, ten of fraction.
double halfByDefinition(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 31;
    const int fraction = bits & 1023;
    const double magnitude =
        exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
    return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

TEST(Half, EveryFiniteOneDecodesAndComesBack) {
    for (std::uint32_t bits = 0; bits < 65536; ++bits) {
        if ((bits & 0x7c00U) == 0x7c00U) {
            continue;
        }
        const float value = floatFromHalf(static_cast<std::uint16_t>(bits));
        ASSERT_EQ(static_cast<double>(value), halfByDefinition(static_cast<std::uint16_t>(bits)));
        ASSERT_EQ(halfFromFloat(value), bits);
    }
}

TEST(Half, RoundsToNearestEven) {
    for (std::uint32_t bits = 0; bits < 0x7bffU; ++bits) {
        const double low = halfByDefinition(static_cast<std::uint16_t>(bits));
        const double high = halfByDefinition(static_cast<std::uint16_t>(bits + 1));
        const auto middle = static_cast<float>(0.5 * (low + high)); // exact in float
        const float inf = std::numeric_limits<float>::infinity();
        ASSERT_EQ(halfFromFloat(middle), bits + (bits & 1U));
        ASSERT_EQ(halfFromFloat(std::nextafter(middle, inf)), bits + 1);
        ASSERT_EQ(halfFromFloat(-std::nextafter(middle, -inf)), bits | 0x8000U);
    }
}

TEST(Half, OverflowsToInfinityAndKeepsNan) {
    EXPECT_EQ(halfFromFloat(65519.9F), 0x7bffU);
    EXPECT_EQ(halfFromFloat(65520.0F), 0x7c00U);
    EXPECT_EQ(halfFromFloat(-1e30F), 0xfc00U);
    EXPECT_TRUE(std::isinf(floatFromHalf(0x7c00U)));
    EXPECT_TRUE(std::isnan(floatFromHalf(halfFromFloat(std::nanf("")))));
}

TEST(TexelFormat, NamesSizesAndExactness) {
    const struct {
        TexelFormat format;
        const char* name;
        std::size_t bytes;
        bool exact;
    } expected[] = {{TexelFormat::R8, "r8", 1, false},
                    {TexelFormat::R16, "r16", 2, false},
                    {TexelFormat::R16F, "r16f", 2, false},
                    {TexelFormat::Rg8Exact, "rg8-exact", 2, true},
                    {TexelFormat::R32fExact, "r32f-exact", 4, true}};
    for (const auto& e : expected) {
        EXPECT_STREQ(name(e.format), e.name);
        EXPECT_EQ(bytesPerTexel(e.format), e.bytes);
        EXPECT_EQ(isExact(e.format), e.exact);
    }
}

TEST(EncodeTexels, BytesAreExactInEveryFormat) {
    std::vector<std::uint8_t> all(256);
    std::iota(all.begin(), all.end(), std::uint8_t{0});
    std::vector<std::int8_t> allSigned(256);
    std::iota(allSigned.begin(), allSigned.end(), std::int8_t{-128});
    for (const TexelFormat format : kAllFormats) {
        expectExact(volumeOf(VoxelType::U8, all), format);
        expectExact(volumeOf(VoxelType::I8, allSigned), format);
    }
}

TEST(EncodeTexels, SixteenBitsAreExactWhereTheFormatHoldsThem) {
    std::vector<std::int16_t> all(65536);
    std::iota(all.begin(), all.end(), std::int16_t{-32768});
    std::vector<std::uint16_t> allUnsigned(65536);
    std::iota(allUnsigned.begin(), allUnsigned.end(), std::uint16_t{0});
    for (const TexelFormat format :
         {TexelFormat::R16, TexelFormat::Rg8Exact, TexelFormat::R32fExact}) {
        for (const double slope : {1.0, -0.1}) { // a negative one turns the codes around
            Volume volume = volumeOf(VoxelType::I16, all);
            volume.rescaleSlope = slope;
            volume.rescaleIntercept = 12.5;
            expectExact(volume, format);
            volume = volumeOf(VoxelType::U16, allUnsigned);
            volume.rescaleSlope = slope;
            expectExact(volume, format);
        }
    }
}

TEST(EncodeTexels, TwelveBitCtIsExactInHalfFloats) {
    std::vector<std::int16_t> ct(4097); // one value more than 12 bits: -2048 to 2048 about 1024
    std::iota(ct.begin(), ct.end(), std::int16_t{-1024});
    expectExact(volumeOf(VoxelType::I16, ct), TexelFormat::R16F);
    Volume rescaled = volumeOf(VoxelType::I16, ct);
    rescaled.rescaleSlope = -2.0;
    expectExact(rescaled, TexelFormat::R16F);
    ct.push_back(ct.back() + 1); // one too many
    EXPECT_GT(encoded(volumeOf(VoxelType::I16, ct), TexelFormat::R16F).maxQuantisationError, 0.0);
}

TEST(EncodeTexels, WideDataErrByAtMostTheBoundOfTheirFormat) {
    std::vector<std::int16_t> all(65536);
    std::iota(all.begin(), all.end(), std::int16_t{-32768});
    std::vector<float> reals(20001);
    for (std::size_t i = 0; i < reals.size(); ++i) {
        reals[i] = 1000.0F + std::sin(static_cast<float>(i)) * 3.0F;
    }
    const struct {
        TexelFormat format;
        double fractionOfRange;
    } bounds[] = {{TexelFormat::R8, 0.5 / 255.0},
                  {TexelFormat::R16, 0.5 / 65535.0},
                  {TexelFormat::R16F, 0x1p-13},
                  {TexelFormat::Rg8Exact, 0.5 / 65535.0}};
    for (const Volume& volume : {volumeOf(VoxelType::I16, all), volumeOf(VoxelType::F32, reals)}) {
        const VolumeStatistics s = computeStatistics(volume);
        for (const auto& bound : bounds) {
            const Texels texels = encoded(volume, bound.format);
            const double range = s.max - s.min;
            EXPECT_LE(texels.maxQuantisationError, bound.fractionOfRange * range * 1.0001);
            EXPECT_NEAR(texels.maxQuantisationError, measuredError(volume, texels), 1e-12 * range);
        }
    }
    EXPECT_GT(encoded(volumeOf(VoxelType::I16, all), TexelFormat::R8).maxQuantisationError, 100.0);
}

TEST(EncodeTexels, FloatsAreExactAsFloats) {
    const std::vector<float> values{0.1F, -3e38F, 3e38F, 1e-37F, -0.0F, 16777217.0F};
    Volume volume = volumeOf(VoxelType::F32, values);
    const Texels texels = encoded(volume, TexelFormat::R32fExact);
    EXPECT_EQ(texels.maxQuantisationError, 0.0);
    EXPECT_EQ(measuredError(volume, texels), 0.0);
    const Texels doubles =
        encoded(volumeOf<double>(VoxelType::F64, {0.1, 0.5}), TexelFormat::R32fExact);
    EXPECT_EQ(doubles.maxQuantisationError, std::abs(static_cast<double>(0.1F) - 0.1));
}

// GPUs take denormals for zero: alone, they are stored as multiples of a power of two.
TEST(EncodeTexels, DenormalsAreExactAndStoredAsNormals) {
    const std::vector<float> values{0x1p-149F, -0x1p-140F, 0x1.8p-142F};
    const Volume volume = volumeOf(VoxelType::F32, values);
    const Texels texels = encoded(volume, TexelFormat::R32fExact);
    EXPECT_EQ(texels.maxQuantisationError, 0.0);
    EXPECT_EQ(measuredError(volume, texels), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_TRUE(std::isnormal(sampledByDefinition(texels, i))) << i;
        EXPECT_GE(std::abs(sampledByDefinition(texels, i)), double(FLT_MIN)) << i;
    }
}

// Differences of what is sampled stay finite in float32.
TEST(EncodeTexels, LargestFloatsKeepFiniteDifferences) {
    const Volume volume = volumeOf<float>(VoxelType::F32, {-3.4e38F, 3.4e38F});
    const Texels texels = encoded(volume, TexelFormat::R32fExact);
    EXPECT_EQ(measuredError(volume, texels), 0.0);
    EXPECT_LE(sampledByDefinition(texels, 1) - sampledByDefinition(texels, 0), double(FLT_MAX));
}

// Nothing divides by a range that float64 cannot divide.
TEST(EncodeTexels, DenormalDoublesDoNoHarm) {
    const Volume volume = volumeOf<double>(VoxelType::F64, {0.0, 1e-310, 5e-324});
    for (const TexelFormat format : kAllFormats) {
        EXPECT_LE(encoded(volume, format).maxQuantisationError, 1e-310) << name(format);
    }
}

TEST(EncodeTexels, WideIntegersAsFloats) {
    using Limits = std::numeric_limits<std::uint32_t>;
    const std::vector<std::uint32_t> wide{0, 1, 123456789, Limits::max()};
    const Texels texels = encoded(volumeOf(VoxelType::U32, wide), TexelFormat::R32fExact);
    EXPECT_GT(texels.maxQuantisationError, 0.0);
    EXPECT_LE(texels.maxQuantisationError, 64.0); // half an ulp just below 2^31
    // Large but close together: the offset keeps them.
    const std::vector<std::uint32_t> close{Limits::max() - (1U << 25), Limits::max() - 12345,
                                           Limits::max()};
    expectExact(volumeOf(VoxelType::U32, close), TexelFormat::R32fExact);
    expectExact(volumeOf<std::int32_t>(VoxelType::I32, {-2147483647 - 1, -2147483600}),
                TexelFormat::R8);
}

TEST(EncodeTexels, ConstantAndSingleVoxels) {
    for (const TexelFormat format : kAllFormats) {
        expectExact(volumeOf<std::int16_t>(VoxelType::I16, {-32768}), format);
        expectExact(volumeOf<float>(VoxelType::F32, {2.5F, 2.5F}), format);
        expectExact(volumeOf<std::uint32_t>(VoxelType::U32, {4294967295U}), format);
    }
}

PROPERTY(EncodeTexels, DecodesFromItsBytesByTheHeadersRule) {
    const auto voxels = anyInt16sNotEmpty();
    Volume volume = volumeOf(VoxelType::I16, voxels);
    volume.rescaleSlope = anyElement(1.0, -1.0, 0.25, -3.0);
    volume.rescaleIntercept = anyElement(0.0, -1024.0, 0.1);
    for (const TexelFormat format : kAllFormats) {
        const Texels texels = encoded(volume, format);
        PROPERTY_ASSERT(texels.data.size() == voxels.size() * bytesPerTexel(format));
        for (std::size_t i = 0; i < voxels.size(); ++i) {
            const double expected =
                texels.valueScale * sampledByDefinition(texels, i) + texels.valueBias;
            const glm::ivec3 at(static_cast<int>(i), 0, 0);
            PROPERTY_ASSERT(std::abs(decodedValue(texels, at) - expected) < 1e-9);
            PROPERTY_ASSERT(std::abs(volume.valueAt(at) - expected) <=
                            texels.maxQuantisationError + 1e-9);
        }
    }
}

template <class T>
void expectSameInPlace(VoxelType type, const std::vector<T>& voxels) {
    for (const TexelFormat format : kAllFormats) {
        for (const double slope : {1.0, -2.0}) {
            Volume volume = volumeOf(type, voxels);
            volume.rescaleSlope = slope;
            const VolumeStatistics statistics = computeStatistics(volume);
            const Texels expected = encodeTexels(volume, statistics, format);
            const std::byte* memory = volume.voxels.data();
            const Texels texels = encodeTexels(std::move(volume), statistics, format);
            EXPECT_EQ(texels.data, expected.data) << name(type) << " as " << name(format);
            EXPECT_EQ(texels.maxQuantisationError, expected.maxQuantisationError);
            EXPECT_EQ(texels.valueScale, expected.valueScale);
            EXPECT_EQ(texels.valueBias, expected.valueBias);
            EXPECT_TRUE(volume.voxels.empty()); // NOLINT: that is what is promised
            EXPECT_EQ(texels.data.data() == memory, sizeof(T) == bytesPerTexel(format));
        }
    }
}

// A volume of 4 GiB is not there twice while texels are made of it.
TEST(EncodeTexels, TakeTheVoxelsOwnMemoryWhereTheyAreAsLong) {
    expectSameInPlace<std::uint8_t>(VoxelType::U8, {0, 1, 7, 255});
    expectSameInPlace<std::uint8_t>(VoxelType::U8, {3, 4, 250});
    expectSameInPlace<std::int8_t>(VoxelType::I8, {-128, -3, 0, 127});
    expectSameInPlace<std::uint16_t>(VoxelType::U16, {0, 5, 300, 65535});
    expectSameInPlace<std::int16_t>(VoxelType::I16, {-32768, -1, 0, 32767});
    expectSameInPlace<std::int32_t>(VoxelType::I32, {-100000, 0, 2000000000});
    expectSameInPlace<std::uint32_t>(VoxelType::U32, {3000000000U, 1, 2});
    expectSameInPlace<float>(VoxelType::F32, {-1.5F, 0.1F, 1e9F});
    expectSameInPlace<double>(VoxelType::F64, {-1.5, 0.1, 1e9});
}

TEST(EncodeTexels, OfOtherStatisticsAreClampedAndSaySo) {
    const Volume volume = volumeOf<std::uint8_t>(VoxelType::U8, {5, 10, 20, 30});
    VolumeStatistics narrow = computeStatistics(volume);
    narrow.min = 10.0;
    narrow.max = 20.0;
    const Texels texels = encodeTexels(volume, narrow, TexelFormat::R8);
    EXPECT_EQ(texels.data, (VoxelBytes{std::byte{0}, std::byte{0}, std::byte{10}, std::byte{20}}));
    EXPECT_EQ(texels.maxQuantisationError, 5.0); // of 5, which 10 stands for
}

/// Values that no format but a large enough one keeps.
template <class T>
std::vector<T> demanding() {
    std::vector<T> values;
    if constexpr (std::is_integral_v<T>) {
        const auto step = std::max<std::int64_t>(
            1,
            (std::int64_t{std::numeric_limits<T>::max()} - std::numeric_limits<T>::min()) / 65535);
        for (std::int64_t i = 0; i <= std::min<std::int64_t>(65535, 1LL << 8 * sizeof(T)); ++i) {
            values.push_back(static_cast<T>(std::numeric_limits<T>::min() + i * step + i % 3 / 2));
        }
    } else {
        values = {T(0.1), T(1) / T(3), T(-1e6), T(1e6)};
    }
    return values;
}

TEST(TexelFormat, KeepsEveryVoxelWhereItSaysSo) {
    for (const VoxelType type : {VoxelType::U8, VoxelType::I8, VoxelType::U16, VoxelType::I16,
                                 VoxelType::U32, VoxelType::I32, VoxelType::F32, VoxelType::F64}) {
        const Volume volume = visitVoxelType(
            type, [&]<class T>(std::type_identity<T>) { return volumeOf(type, demanding<T>()); });
        for (const TexelFormat format : kAllFormats) {
            EXPECT_EQ(keepsEveryVoxel(format, type),
                      encoded(volume, format).maxQuantisationError == 0.0)
                << name(type) << " as " << name(format);
        }
    }
}

void expectCodesBracketTheirTexels(const Volume& volume, TexelFormat format) {
    const Texels texels = encoded(volume, format);
    const TexelCodes codes = encodeCodes(texels);
    ASSERT_EQ(codes.dims, texels.dims);
    ASSERT_EQ(codes.lowSampled.size(), format == TexelFormat::R8 ? 256U : 65536U);
    ASSERT_EQ(codes.highSampled.size(), codes.lowSampled.size());
    for (std::size_t c = 0; c < codes.lowSampled.size(); ++c) {
        ASSERT_LE(codes.lowSampled[c], codes.highSampled[c]) << c;
        if (c > 0) {
            ASSERT_LE(codes.lowSampled[c - 1], codes.lowSampled[c]) << c;
            ASSERT_LE(codes.highSampled[c - 1], codes.highSampled[c]) << c;
        }
    }
    ASSERT_EQ(codes.bytes.empty(), format != TexelFormat::R8);
    const auto codeAt = [&](std::size_t i) {
        return codes.visit([=](const auto* all) { return std::uint16_t(all[i]); });
    };
    for (std::size_t i = 0; i < std::size_t(codes.count()); ++i) {
        const double sampled = sampledByDefinition(texels, i);
        const std::uint16_t code = codeAt(i);
        ASSERT_LE(codes.lowSampled[code], static_cast<float>(sampled));
        ASSERT_GE(codes.highSampled[code], static_cast<float>(sampled));
        if (i > 0) {
            const double before = sampledByDefinition(texels, i - 1);
            ASSERT_TRUE(before < sampled ? codeAt(i - 1) <= code
                                         : codeAt(i - 1) >= code || before == sampled);
        }
    }
}

TEST(EncodeCodes, FollowTheOrderOfValues) {
    std::vector<std::int16_t> all(65536);
    std::iota(all.begin(), all.end(), std::int16_t{-32768});
    std::uint32_t state = 7;
    for (std::size_t i = all.size() - 1; i > 0; --i) {
        state = state * 1664525U + 1013904223U;
        std::swap(all[i], all[(state >> 8) % (i + 1)]);
    }
    for (const TexelFormat format : kAllFormats) {
        Volume volume = volumeOf(VoxelType::I16, all);
        expectCodesBracketTheirTexels(volume, format);
        volume.rescaleSlope = -1.0;
        expectCodesBracketTheirTexels(volume, format);
    }
}

TEST(EncodeCodes, OfIntegersAreTheIntegers) {
    const Volume volume = volumeOf<std::uint16_t>(VoxelType::U16, {0, 1, 258, 65535});
    for (const TexelFormat format : {TexelFormat::R16, TexelFormat::Rg8Exact}) {
        EXPECT_EQ(encodeCodes(encoded(volume, format)).codes,
                  (std::vector<std::uint16_t>{0, 1, 258, 65535}));
    }
}

// What a 512^3 volume of 8 bits keeps on the host is 128 MB of texels, not 256 MB of codes beside.
TEST(EncodeCodes, OfBytesAreTheTexelsThemselves) {
    const auto texels = std::make_shared<const Texels>(
        encoded(volumeOf<std::uint8_t>(VoxelType::U8, {3, 0, 255, 7}), TexelFormat::R8));
    const TexelCodes codes = encodeCodes(*texels, texels);
    EXPECT_TRUE(codes.codes.empty());
    EXPECT_EQ(codes.count(), 4);
    EXPECT_EQ(static_cast<const void*>(codes.bytes.data()), texels->data.data());
    EXPECT_EQ(texels.use_count(), 2); // kept, whoever lets go of them
    EXPECT_EQ(codes.bytes[2], 255);
}

TEST(EncodeCodes, HalvesOrderLikeTheirValuesAndStayFinite) {
    const Texels texels =
        encoded(volumeOf<float>(VoxelType::F32, {-1.0F, 1.0F}), TexelFormat::R16F);
    const TexelCodes codes = encodeCodes(texels);
    for (std::uint32_t bits = 0; bits < 65536; ++bits) {
        ASSERT_TRUE(std::isfinite(codes.lowSampled[bits]));
    }
    EXPECT_EQ(codes.lowSampled[0x8000], 0.0F);
    EXPECT_EQ(codes.lowSampled[0xffff], 65504.0F);
    EXPECT_EQ(codes.lowSampled[0x0000], -65504.0F);
    EXPECT_EQ(codes.lowSampled[0x8001], 0x1p-24F);
    EXPECT_EQ(codes.lowSampled[0x7ffe], -0x1p-24F);
}

TEST(EncodeCodes, BinsOfFloatsBracketAlsoExtremes) {
    const float huge = std::numeric_limits<float>::max();
    const std::vector<std::vector<float>> sets{
        {1.0F, std::nextafter(1.0F, 2.0F), 1.5F, 2.0F},
        {-huge, -1e-10F, -0.0F, 1e-45F, 1e-10F, 1.0F, huge}, // cancels in float64
        {1e30F, std::nextafter(1e30F, huge)},
        {0.0F, 1e-45F},
        {7.0F},
    };
    for (const std::vector<float>& set : sets) {
        expectCodesBracketTheirTexels(volumeOf(VoxelType::F32, set), TexelFormat::R32fExact);
    }
    checkProperty([] {
        const int shift = anyInt(-30, 30);
        std::vector<float> values;
        for (int i = 0; i < 40; ++i) {
            values.push_back(
                std::ldexp(static_cast<float>(anyInt(-1 << 23, 1 << 23)), anyInt(-12, 1) + shift));
        }
        expectCodesBracketTheirTexels(volumeOf(VoxelType::F32, values), TexelFormat::R32fExact);
        PROPERTY_ASSERT(!::testing::Test::HasFatalFailure());
    });
}

TEST(EncodeCodes, BinsOfFloatsAreNarrow) {
    std::vector<float> values(1001);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<float>(i) * 0.001F;
    }
    const TexelCodes codes =
        encodeCodes(encoded(volumeOf(VoxelType::F32, values), TexelFormat::R32fExact));
    for (const std::uint16_t code : codes.codes) {
        EXPECT_LE(codes.highSampled[code] - codes.lowSampled[code], 1.01F / 65536.0F);
    }
}

} // namespace
} // namespace slabcast

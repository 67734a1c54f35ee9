#include "core/skip/value_bins.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "core/volume/half.h"
#include "tests/support/property.h"
#include "tests/support/skip_scene.h"

namespace slabcast {
namespace {

using test::anyBits;
using test::anyBool;
using test::anyElement;
using test::anyInt;
using test::anyIntsNotEmpty;
using test::anyPairs;
using test::intsInRange;
using test::intsOf;
using test::ofSize;

bool has(const BinSet& set, int bin) {
    return (set[bin / 32] >> (bin % 32) & 1U) != 0;
}

/// A few codes whose sampled values rise unevenly, some of them binned floats that overlap. The
/// wide steps have room for values that no code stands for.
TexelCodes randomCodes() {
    const auto steps = anyIntsNotEmpty(intsOf({0, 1, 1, 1, 2, 5, 40, 40}));
    const float width = float(anyElement(0, 0, 1, 3));
    TexelCodes codes;
    codes.dims = glm::ivec3(int(steps.size()), 1, 1);
    float value = float(anyInt(-50, 50));
    for (std::size_t code = 0; code < steps.size(); ++code) {
        value += float(steps[code]);
        codes.codes.push_back(std::uint16_t(code));
        codes.lowSampled.push_back(value);
        codes.highSampled.push_back(value + width);
    }
    return codes;
}

/// Up to four visible runs of texels, from half a value to four apart, over all of the values, a
/// part of them, or more.
TransferTable randomTable(const TexelCodes& codes) {
    const double low = codes.lowSampled.front() + anyInt(-20, 20);
    const double span = 1.0 + std::abs(codes.lowSampled.back() - low);
    const int size = 2 + int(span * anyElement(0.25, 1.0, 2.0));
    TransferTable table{low, low + span, std::vector<glm::vec4>(size, glm::vec4(0.0F))};
    const auto runs = anyPairs(4, ofSize(100, intsInRange(0, size)), intsOf({0, 0, 1, 5, 50}));
    for (const auto& [first, length] : runs) {
        for (int k = first; k <= std::min(size - 1, first + length); ++k) {
            table.texels[k].a = 0.5F;
        }
    }
    return table;
}

CodeRange randomRange(const TexelCodes& codes) {
    const int end = int(codes.lowSampled.size());
    const auto a = std::uint16_t(anyInt(0, end));
    const auto b = std::uint16_t(anyInt(0, end));
    return {std::min(a, b), std::max(a, b)};
}

ValueBins randomBins(const TexelCodes& codes) {
    std::optional<std::array<double, 2>> trimmed;
    if (anyBool()) {
        const double low = codes.lowSampled.front() + anyInt(-10, 100);
        trimmed = {low, low + anyInt(1, 100)};
    }
    return valueBins(codes, randomRange(codes), anyElement(2, 3, 8, 16, 32, 128, 256), anyBool(),
                     trimmed);
}

/// How many bins of the set the cells of each pair of codes have, all pairs: cells that are visible
/// have one at least, and every bin of the set is the only one that some visible cell has there.
void checkSet(const ValueBins& bins, const CellVisibility& visibility, const BinSet& set) {
    const std::size_t codes = bins.binOfCode.size();
    BinSet needed{};
    for (std::size_t least = 0; least < codes; ++least) {
        for (std::size_t greatest = least; greatest < codes; ++greatest) {
            if (!visibility.visible(std::uint16_t(least), std::uint16_t(greatest))) {
                continue;
            }
            std::vector<int> common;
            for (int bin = bins.binOfCode[least]; bin <= bins.binOfCode[greatest]; ++bin) {
                if (has(set, bin)) {
                    common.push_back(bin);
                }
            }
            PROPERTY_ASSERT(!common.empty());
            if (common.size() == 1) {
                needed[common[0] / 32] |= 1U << (common[0] % 32);
            }
        }
    }
    PROPERTY_ASSERT(needed == set);
}

PROPERTY(VisibleBins, AreThoseThatVisibleCellsNeed) {
    const TexelCodes codes = randomCodes();
    const ValueBins bins = randomBins(codes);
    const double filterError = anyElement(0.0, 0.0, 0.3, 2.0);
    const CellVisibility visibility =
        cellVisibility(codes, Texels{}, randomTable(codes), filterError);
    checkSet(bins, visibility, visibleBins(bins, visibility));
}

PROPERTY(VisibleBins, OfAlpha) {
    TexelCodes codes;
    codes.lowSampled.resize(256);
    std::iota(codes.lowSampled.begin(), codes.lowSampled.end(), 0.0F);
    const ValueBins bins = randomBins(codes);
    const CellVisibility visibility = cellVisibilityOfAlpha(codes);
    checkSet(bins, visibility, visibleBins(bins, visibility));
}

/// A visible value that no code stands for, between two bins: one of the two is enough, the lower.
TEST(VisibleBins, BetweenTwoBinsTheLowerCounts) {
    test::SkipScene scene = test::constantScene({1, 1, 1}, 0, test::bandTable(1001, 500, 500));
    scene.codes.lowSampled = {0.0F, 10.0F, 990.0F, 1000.0F};
    scene.codes.highSampled = scene.codes.lowSampled;
    const CellVisibility visibility = scene.visibility();
    const ValueBins bins{4, {0, 1, 2, 3}};
    EXPECT_EQ(visibleBins(bins, visibility), (BinSet{1U << 1}));
    EXPECT_EQ(visibleBins({256, {0, 40, 200, 255}}, visibility), (BinSet{0, 1U << 8}));
    EXPECT_EQ(visibleBins({2, {0, 0, 0, 1}}, visibility), (BinSet{1U}));
}

TEST(VisibleBins, NothingVisibleNeedsNone) {
    const test::SkipScene scene = test::constantScene({1, 1, 1}, 0, test::bandTable(256, 0, -1));
    const ValueBins bins = valueBins(scene.codes, {0, 255}, 256, false);
    EXPECT_EQ(visibleBins(bins, scene.visibility()), BinSet{});
}

/// All codes have a bin, bins rise with codes, and where the value says so exactly.
PROPERTY(ValueBins, AreEvenInValue) {
    const TexelCodes codes = randomCodes();
    const CodeRange range = randomRange(codes);
    const int count = anyElement(2, 3, 8, 16, 32, 128, 256);
    const bool separate = anyBool();
    const bool trim = anyBool();
    const std::size_t first = std::min<std::size_t>(range.least + (separate ? 1 : 0), range.most);
    std::array<double, 2> span{codes.lowSampled[first], codes.lowSampled[range.most]};
    if (trim) {
        span[0] += anyInt(-10, 10);
        span[1] = span[0] + anyInt(1, 100);
    }
    const ValueBins bins =
        valueBins(codes, range, count, separate, trim ? std::optional(span) : std::nullopt);
    PROPERTY_ASSERT(bins.count == count);
    PROPERTY_ASSERT(bins.binOfCode.size() == codes.lowSampled.size());
    PROPERTY_ASSERT(std::is_sorted(bins.binOfCode.begin(), bins.binOfCode.end()));
    const int even = count - (separate ? 1 : 0);
    for (int code = 0; code < int(codes.lowSampled.size()); ++code) {
        const int bin = bins.binOfCode[code];
        if (separate && code <= range.least) {
            PROPERTY_ASSERT(bin == 0);
            continue;
        }
        // Values and spans are whole numbers: bin k spans [k, k+1] * (span / even) from the low
        // end, and on a border, which is a quotient that rounds, either side will do.
        const long value = std::lround((codes.lowSampled[code] - span[0])) * even;
        const long width = std::lround(span[1] - span[0]);
        const long k = bin - (count - even);
        PROPERTY_ASSERT(k >= 0);
        PROPERTY_ASSERT(k < even);
        PROPERTY_ASSERT((k == 0 || width == 0 || value >= k * width));
        PROPERTY_ASSERT((k == even - 1 || width == 0 || value <= (k + 1) * width));
    }
}

TexelCodes integerCodes(int count) {
    TexelCodes codes;
    for (int c = 0; c < count; ++c) {
        codes.lowSampled.push_back(float(c));
    }
    codes.highSampled = codes.lowSampled;
    return codes;
}

TEST(ValueBins, ShareIntegersEvenly) {
    const TexelCodes bytes = integerCodes(256);
    const TexelCodes words = integerCodes(65536);
    for (const int count : {8, 16, 32, 64, 128, 256}) {
        const ValueBins ofBytes = valueBins(bytes, {0, 255}, count, false);
        const ValueBins ofWords = valueBins(words, {4096, 8191}, count, false);
        for (int c = 0; c < 256; ++c) {
            EXPECT_EQ(ofBytes.binOfCode[c], c * count / 256);
        }
        for (int c = 0; c < 65536; ++c) {
            ASSERT_EQ(ofWords.binOfCode[c], std::clamp((c - 4096) * count / 4096, 0, count - 1));
        }
    }
}

TEST(ValueBins, SeparateTheMinimumAlone) {
    const ValueBins bins = valueBins(integerCodes(256), {10, 73}, 64, true);
    for (int c = 0; c < 256; ++c) {
        EXPECT_EQ(bins.binOfCode[c], std::clamp(c - 10, 0, 63)) << c;
    }
}

TEST(ValueBins, OfASingleValue) {
    for (const bool separate : {false, true}) {
        const ValueBins bins = valueBins(integerCodes(256), {7, 7}, 16, separate);
        EXPECT_EQ(bins.binOfCode[7], 0);
        EXPECT_TRUE(std::is_sorted(bins.binOfCode.begin(), bins.binOfCode.end()));
        EXPECT_LT(bins.binOfCode.back(), 16);
    }
}

TexelCodes codesOf(TexelFormat format, std::vector<std::byte> data) {
    Texels texels{.format = format, .data = std::move(data)};
    texels.dims = {int(texels.data.size() / bytesPerTexel(format)), 1, 1};
    return encodeCodes(texels);
}

template <class Texel>
std::vector<std::byte> bytesOf(const std::vector<Texel>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    return {bytes.begin(), bytes.end()};
}

/// Codes of halfs are dense around zero: bins are even in value nevertheless.
TEST(ValueBins, OfHalfsAreEvenInValue) {
    std::vector<std::uint16_t> halfs;
    for (int value = -1024; value <= 1024; ++value) {
        halfs.push_back(halfFromFloat(float(value)));
    }
    const TexelCodes codes = codesOf(TexelFormat::R16F, bytesOf(halfs));
    const ValueBins bins = valueBins(codes, codeRange(codes), 16, false);
    for (int i = 0; i < int(codes.codes.size()); ++i) {
        EXPECT_EQ(bins.binOfCode[codes.codes[i]], std::min(15, i / 128)) << i - 1024;
    }
}

TEST(ValueBins, OfFloatsAreEvenInValue) {
    std::vector<float> floats;
    for (int i = 0; i <= 4096; ++i) {
        floats.push_back(float(i) * 0.25F - 300.0F);
    }
    const TexelCodes codes = codesOf(TexelFormat::R32fExact, bytesOf(floats));
    const ValueBins bins = valueBins(codes, codeRange(codes), 16, false);
    for (int i = 1; i <= 4096; ++i) { // a code's low end lies below its values: at borders, one bin
        const int bin = bins.binOfCode[codes.codes[i]];
        EXPECT_TRUE(bin == std::min(15, i / 256) || (i % 256 == 0 && bin == i / 256 - 1)) << i;
    }
}

/// Real codes, too many for all pairs.
PROPERTY(VisibleBins, OfHalfsAndFloats) {
    const unsigned seed = anyBits();
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0.0F, 300.0F);
    std::vector<float> floats(100);
    std::generate(floats.begin(), floats.end(), [&] { return normal(random); });
    std::vector<std::uint16_t> halfs;
    std::transform(floats.begin(), floats.end(), std::back_inserter(halfs), halfFromFloat);
    const TexelCodes codes = anyBool() ? codesOf(TexelFormat::R16F, bytesOf(halfs))
                                       : codesOf(TexelFormat::R32fExact, bytesOf(floats));
    const auto center = double(floats[0]);
    TransferTable table{center - 20.0, center + 20.0, std::vector<glm::vec4>(256)};
    table.texels[random() % 256].a = 1.0F;
    const CellVisibility visibility = cellVisibility(codes, Texels{}, table, 0.0);
    const ValueBins bins = valueBins(codes, codeRange(codes), 64, anyBool());
    const BinSet set = visibleBins(bins, visibility);
    for (int i = 0; i < 2000; ++i) {
        const std::uint16_t a = codes.codes[random() % 100];
        const std::uint16_t b = codes.codes[random() % 100];
        bool common = false;
        const auto [low, high] = std::minmax(a, b);
        for (int bin = bins.binOfCode[low]; bin <= bins.binOfCode[high]; ++bin) {
            common = common || has(set, bin);
        }
        PROPERTY_ASSERT((common || !visibility.visible(low, high)));
    }
}

TEST(CodeRange, IsThatOfAllCodes) {
    std::mt19937 random(7);
    for (const int size : {1, 1000, 700000}) { // one part, and several
        TexelCodes codes;
        codes.codes.resize(size);
        std::generate(codes.codes.begin(), codes.codes.end(),
                      [&] { return std::uint16_t(1000 + random() % 60000); });
        const auto [least, most] = std::minmax_element(codes.codes.begin(), codes.codes.end());
        const CodeRange range = codeRange(codes);
        EXPECT_EQ(range.least, *least);
        EXPECT_EQ(range.most, *most);
    }
}

} // namespace
} // namespace slabcast

#include "core/skip/partitioned_maps.h"

#include <gtest/gtest.h>

#include "core/skip/chebyshev.h"
#include "tests/support/property.h"
#include "tests/support/skip_blocks.h"

namespace slabcast {
namespace {

using test::anyBool;
using test::anyElement;
using test::anyInt;
using test::anyInts;
using test::bandTable;
using test::constantScene;
using test::intsInRange;
using test::intsOf;
using test::intsOfEither;
using test::randomEdge;
using test::randomScene;
using test::SkipScene;

SkipOptions partitionedOptions(int partitions, int edge) {
    return {
        .structure = SkipStructure::Partitioned, .blockEdgeVoxels = edge, .partitions = partitions};
}

SkipOptions randomOptions() {
    return partitionedOptions(anyElement(16, 16, 32, 64, 128, 256), randomEdge());
}

ValueBins randomBins(const SkipScene& scene, int partitions) {
    std::optional<std::array<double, 2>> trimmed;
    if (anyBool()) {
        const double low = anyInt(0, 200);
        trimmed = {low, low + anyInt(1, 56)};
    }
    return valueBins(scene.codes, codeRange(scene.codes), partitions, anyBool(), trimmed);
}

PartitionedMaps built(const SkipScene& scene, const ValueBins& bins, const SkipOptions& options) {
    const auto maps = buildPartitionedMaps(scene.codes, bins, options);
    EXPECT_TRUE(maps.has_value());
    return *maps;
}

std::vector<std::uint8_t> mapOf(const PartitionedMaps& maps, int partition) {
    const std::int64_t perMap = std::int64_t(maps.blocks.x) * maps.blocks.y * maps.blocks.z;
    const auto begin = maps.distances.begin() + partition * perMap;
    return {begin, begin + perMap};
}

BinSet setOf(const std::vector<int>& bins) {
    BinSet set{};
    for (const int bin : bins) {
        set[bin / 32] |= 1U << (bin % 32);
    }
    return set;
}

/// Some of them, the last one often.
std::vector<int> randomMembers(int bins) {
    return anyInts(intsOfEither(intsInRange(0, bins), intsOf({bins - 1})));
}

/// A cell is visible where a visible code lies between its corners, both included: no more, no
/// less.
CellVisibility visibilityOfCodes(const TexelCodes& codes, const std::vector<bool>& visible) {
    CellVisibility visibility{&codes, std::vector<std::uint16_t>(256),
                              std::vector<std::uint16_t>(256)};
    std::uint16_t next = 256;
    for (int code = 255; code >= 0; --code) {
        next = visible[code] ? std::uint16_t(code) : next;
        visibility.firstVisible[code] = next;
        visibility.reach[code] = std::uint16_t(code);
    }
    return visibility;
}

PROPERTY(PartitionedMaps, AreTheDistancesToCellsWithTheirValues) {
    const SkipScene scene = randomScene(10);
    const SkipOptions options = randomOptions();
    const ValueBins bins = randomBins(scene, options.partitions);
    const PartitionedMaps maps = built(scene, bins, options);
    PROPERTY_ASSERT(maps.blocks ==
                    (scene.geometry.dims + options.blockEdgeVoxels - 1) / options.blockEdgeVoxels);
    PROPERTY_ASSERT(maps.blockEdgeVoxels == options.blockEdgeVoxels);
    PROPERTY_ASSERT(maps.bins.binOfCode == bins.binOfCode);
    for (int p = 0; p < options.partitions; ++p) {
        const auto occupied = test::blocksThatCellsMeet(
            scene, options.blockEdgeVoxels, [&](std::uint16_t least, std::uint16_t greatest) {
                return bins.binOfCode[least] <= p && p <= bins.binOfCode[greatest];
            });
        PROPERTY_ASSERT(mapOf(maps, p) == test::chebyshevByTheWords(occupied, maps.blocks));
    }
}

PROPERTY(PartitionedMaps, MergeToTheLeastDistance) {
    const SkipScene scene = randomScene(24);
    const SkipOptions options = randomOptions();
    const PartitionedMaps maps = built(scene, randomBins(scene, options.partitions), options);
    const std::vector<int> members = randomMembers(options.partitions);
    std::vector<std::uint8_t> least(mapOf(maps, 0).size(), 255);
    for (const int p : members) {
        const std::vector<std::uint8_t> map = mapOf(maps, p);
        for (std::size_t i = 0; i < least.size(); ++i) {
            least[i] = std::min(least[i], map[i]);
        }
    }
    const FreeLengths result = merged(maps, setOf(members));
    PROPERTY_ASSERT(result.blocks == maps.blocks);
    PROPERTY_ASSERT(result.blockEdgeVoxels == maps.blockEdgeVoxels);
    PROPERTY_ASSERT(result.quantumMm == 0.0);
    PROPERTY_ASSERT(result.counts == least);
    PROPERTY_ASSERT(result.occupiedBlocks == std::count(least.begin(), least.end(), 0));
}

PROPERTY(PartitionedMaps, AreNowhereFreerThanTheTransferFunction) {
    const SkipScene scene = randomScene(24);
    const SkipOptions options = randomOptions();
    const PartitionedMaps maps = built(scene, randomBins(scene, options.partitions), options);
    const CellVisibility visibility = scene.visibility(anyElement(0.0, 0.7));
    const FreeLengths result = merged(maps, visibleBins(maps.bins, visibility));
    const auto exact = buildChebyshev(visibility, options.blockEdgeVoxels);
    PROPERTY_ASSERT(exact.has_value());
    for (std::size_t i = 0; i < result.counts.size(); ++i) {
        PROPERTY_ASSERT(result.counts[i] <= exact->counts[i]);
    }
}

PROPERTY(PartitionedMaps, OfWholePartitionsAreExact) {
    const SkipScene scene = randomScene(24);
    const SkipOptions options = randomOptions();
    const PartitionedMaps maps = built(scene, randomBins(scene, options.partitions), options);
    const BinSet shown = setOf(randomMembers(options.partitions));
    std::vector<bool> visible(256);
    for (int code = 0; code < 256; ++code) {
        const int bin = maps.bins.binOfCode[code];
        visible[code] = (shown[bin / 32] >> (bin % 32) & 1U) != 0;
    }
    const CellVisibility visibility = visibilityOfCodes(scene.codes, visible);
    const auto exact = buildChebyshev(visibility, options.blockEdgeVoxels);
    PROPERTY_ASSERT(exact.has_value());
    PROPERTY_ASSERT(merged(maps, visibleBins(maps.bins, visibility)) == *exact);
}

/// Larger than what one thread takes at once.
TEST(PartitionedMaps, MergeOnAllCores) {
    SkipScene scene = constantScene({64, 64, 96}, 0, bandTable(256, 200, 255));
    scene.code({1, 1, 1}) = 100;
    scene.code({60, 60, 90}) = 200;
    const PartitionedMaps maps =
        built(scene, valueBins(scene.codes, {0, 255}, 16, false), partitionedOptions(16, 1));
    const FreeLengths result = merged(maps, setOf({5, 12}));
    ASSERT_GT(result.counts.size(), std::size_t(2) << 17);
    const std::vector<std::uint8_t> fifth = mapOf(maps, 5);
    const std::vector<std::uint8_t> twelfth = mapOf(maps, 12);
    for (std::size_t i = 0; i < result.counts.size(); ++i) {
        ASSERT_EQ(result.counts[i], std::min(fifth[i], twelfth[i])) << i;
    }
    // Cells with voxel v span [v - 0.5, v + 1.5], which the blocks from v - 2 to v + 2 meet within
    // a voxel.
    EXPECT_EQ(result.occupiedBlocks, 4 * 4 * 4 + 5 * 5 * 5);
}

TEST(PartitionedMaps, OfTheEmptySetAreFreeEverywhere) {
    const SkipScene scene = constantScene({9, 7, 5}, 0, bandTable(256, 200, 255));
    const PartitionedMaps maps =
        built(scene, valueBins(scene.codes, {0, 255}, 16, false), partitionedOptions(16, 4));
    const FreeLengths result = merged(maps, BinSet{});
    EXPECT_EQ(result.counts, std::vector<std::uint8_t>(12, 255));
    EXPECT_EQ(result.occupiedBlocks, 0);
}

TEST(PartitionedMaps, KeepToTheBudget) {
    const SkipScene scene = constantScene({9, 7, 5}, 0, bandTable(256, 200, 255));
    const ValueBins bins = valueBins(scene.codes, {0, 255}, 16, false);
    SkipOptions options = partitionedOptions(16, 4);
    options.memoryBudgetBytes = 12 * 16;
    EXPECT_TRUE(buildPartitionedMaps(scene.codes, bins, options).has_value());
    options.memoryBudgetBytes = 12 * 16 - 1;
    const auto maps = buildPartitionedMaps(scene.codes, bins, options);
    ASSERT_FALSE(maps.has_value());
    EXPECT_EQ(maps.error().code, ErrorCode::VolumeTooLarge);
}

/// Codes that are not there, of a volume that would fill petabytes: neither is touched.
TEST(PartitionedMaps, AreRefusedBeforeAnythingIsDone) {
    TexelCodes codes = constantScene({1, 1, 1}, 0, bandTable(256, 200, 255)).codes;
    codes.dims = glm::ivec3(60000);
    codes.codes.clear();
    const ValueBins bins = valueBins(codes, {0, 255}, 256, false);
    const auto maps = buildPartitionedMaps(codes, bins, partitionedOptions(256, 1));
    ASSERT_FALSE(maps.has_value());
    EXPECT_EQ(maps.error().code, ErrorCode::VolumeTooLarge);
    const std::int64_t needed = std::int64_t(60000) * 60000 * 60000 / (1 << 20) * 256;
    EXPECT_NE(maps.error().detail.find("256 partitions at block edge 1: they need "),
              std::string::npos);
    EXPECT_NEAR(std::stod(maps.error().detail.substr(42)), double(needed), 257.0);
    EXPECT_NE(maps.error().detail.find("over the budget of 256 MiB; take fewer partitions, a "
                                       "larger block edge or a larger budget"),
              std::string::npos);
}

TEST(PartitionedMaps, StopWhenCancelled) {
    const SkipScene scene = constantScene({64, 64, 64}, 255, bandTable(256, 200, 255));
    const CancelToken cancel(true);
    const auto maps = buildPartitionedMaps(scene.codes, valueBins(scene.codes, {0, 255}, 16, false),
                                           partitionedOptions(16, 4), &cancel);
    ASSERT_FALSE(maps.has_value());
    EXPECT_EQ(maps.error().code, ErrorCode::Internal);
}

} // namespace
} // namespace slabcast

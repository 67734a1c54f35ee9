#include "core/skip/partitioned_maps.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "core/skip/chebyshev.h"
#include "core/skip/occupancy.h"

namespace slabcast {

namespace {

std::int64_t blockCount(glm::ivec3 blocks) {
    return std::int64_t(blocks.x) * blocks.y * blocks.z;
}

std::string mebibytes(std::int64_t bytes) {
    constexpr std::int64_t kMebi = 1 << 20;
    return std::to_string((bytes + kMebi - 1) / kMebi) + " MiB";
}

/// First and last partition of each block: bins rise with codes, and the cells of a block, of
/// which neighbours share corners, have every value between the least and the greatest.
struct PartitionRanges {
    std::vector<std::uint8_t> first;
    std::vector<std::uint8_t> last;
};

PartitionRanges partitionRanges(const OctreeLevel& ranges, const ValueBins& bins) {
    constexpr std::int64_t kGrain = 1 << 16;
    PartitionRanges partitions{std::vector<std::uint8_t>(ranges.words.size()),
                               std::vector<std::uint8_t>(ranges.words.size())};
    const std::uint32_t* words = ranges.words.data();
    std::uint8_t* first = partitions.first.data();
    std::uint8_t* last = partitions.last.data();
    parallelFor(std::int64_t(ranges.words.size()), kGrain,
                [=, &bins](std::int64_t begin, std::int64_t end) {
                    for (std::int64_t i = begin; i < end; ++i) {
                        const NodeRange range = NodeRange::of(words[i]);
                        first[i] = bins.binOfCode[range.least];
                        last[i] = bins.binOfCode[range.greatest];
                    }
                });
    return partitions;
}

/// 0 where a block has the partition, else 255.
void markPartition(const PartitionRanges& ranges, std::uint8_t partition,
                   std::uint8_t* __restrict bytes) {
    const std::uint8_t* first = ranges.first.data();
    const std::uint8_t* last = ranges.last.data();
    const std::size_t blocks = ranges.first.size();
    for (std::size_t i = 0; i < blocks; ++i) {
        bytes[i] = first[i] <= partition && partition <= last[i] ? 0 : 255;
    }
}

void include(const std::uint8_t* distances, std::int64_t count, std::uint8_t* __restrict merged) {
    for (std::int64_t i = 0; i < count; ++i) {
        merged[i] = std::min(merged[i], distances[i]);
    }
}

std::vector<int> members(const BinSet& set, int bins) {
    std::vector<int> list;
    for (int bin = 0; bin < bins; ++bin) {
        if ((set[bin / 32] >> (bin % 32) & 1U) != 0) {
            list.push_back(bin);
        }
    }
    return list;
}

} // namespace

PartitionLimit budgetOf(const SkipOptions& options) {
    return {options.memoryBudgetBytes, "the budget",
            "take fewer partitions, a larger block edge or a larger budget"};
}

Result<void> checkPartitions(const SkipOptions& options, std::int64_t bytes,
                             const PartitionLimit& limit) {
    if (bytes <= limit.bytes) {
        return {};
    }
    return fail(ErrorCode::VolumeTooLarge,
                std::to_string(options.partitions) + " partitions at block edge " +
                    std::to_string(options.blockEdgeVoxels) + ": they need " + mebibytes(bytes) +
                    " (" + std::to_string(bytes) + " bytes), over " + limit.name + " of " +
                    mebibytes(limit.bytes) + "; " + limit.remedy);
}

Result<PartitionedMaps> buildPartitionedMaps(const TexelCodes& codes, ValueBins bins,
                                             const SkipOptions& options,
                                             const CancelToken* cancel) {
    const int edge = options.blockEdgeVoxels;
    SLABCAST_EXPECTS(bins.count == options.partitions, bins.count);
    const glm::ivec3 blocks = blocksOf(codes.dims, edge);
    const std::int64_t perMap = blockCount(blocks);
    const std::int64_t bytes = perMap * bins.count;
    if (Result<void> fits = checkPartitions(options, bytes, budgetOf(options)); !fits) {
        return tl::unexpected(fits.error());
    }
    const Result<OctreeLevel> ranges = blockRanges(codes, edge, cancel);
    if (!ranges) {
        return tl::unexpected(ranges.error());
    }
    const PartitionRanges partitions = partitionRanges(*ranges, bins);
    std::vector<std::uint8_t> distances(static_cast<std::size_t>(bytes));
    const auto transform = [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t p = begin; p < end; ++p) {
            const ChebyshevTransform map{blocks, distances.data() + p * perMap};
            markPartition(partitions, std::uint8_t(p), map.bytes);
            map.withinSlices(0, blocks.z);
            map.upwards(0, blocks.z);
            map.downwards(0, blocks.z);
        }
    };
    return runStages({{bins.count, transform}}, cancel).map([&] {
        return PartitionedMaps{std::move(bins), blocks, edge, std::move(distances)};
    });
}

FreeLengths merged(const PartitionedMaps& maps, const BinSet& set) {
    constexpr std::int64_t kRun = 1 << 14;   // bytes that stay in the first cache
    constexpr std::int64_t kGrain = 1 << 17; // bytes that are worth another thread
    const std::int64_t perMap = blockCount(maps.blocks);
    const std::vector<int> partitions = members(set, maps.bins.count);
    FreeLengths result{.blocks = maps.blocks,
                       .blockEdgeVoxels = maps.blockEdgeVoxels,
                       .counts = std::vector<std::uint8_t>(std::size_t(perMap), 255)};
    std::atomic<std::int64_t> occupied{0};
    parallelFor(perMap, kGrain, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t first = begin; first < end; first += kRun) {
            const std::int64_t count = std::min(kRun, end - first);
            std::uint8_t* counts = result.counts.data() + first;
            for (const int partition : partitions) {
                include(maps.distances.data() + partition * perMap + first, count, counts);
            }
            occupied += std::count(counts, counts + count, std::uint8_t(0));
        }
    });
    result.occupiedBlocks = occupied;
    return result;
}

} // namespace slabcast

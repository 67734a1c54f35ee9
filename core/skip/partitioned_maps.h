#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/skip/free_lengths.h"
#include "core/skip/skip_structure.h"
#include "core/skip/value_bins.h"
#include "core/volume/texels.h"

namespace slabcast {

/// For every bin of values, a partition, the distance in blocks to the closest one that a cell with
/// such values may meet: Chebyshev maps that no TF changes.
struct PartitionedMaps {
    ValueBins bins;
    glm::ivec3 blocks{0};
    int blockEdgeVoxels = 4;
    std::vector<std::uint8_t> distances; // partition by partition, of each blocks x fastest
};

/// What bounds the bytes of partitioned maps, and what helps where they are more.
struct PartitionLimit {
    std::int64_t bytes = 0;
    const char* name = "";
    const char* remedy = "";
};

PartitionLimit budgetOf(const SkipOptions& options);

/// Fails: VolumeTooLarge, naming what is needed, where maps of so many bytes are beyond the limit.
Result<void> checkPartitions(const SkipOptions& options, std::int64_t bytes,
                             const PartitionLimit& limit);

/// Partition p occupies a block where, of the cells that meet it grown by one voxel, one has p
/// between the bins of its least and its greatest corner. Contract: `options` are valid, and the
/// bins as many as their partitions. Cost: O(voxels + blocks * partitions), all cores. Fails:
/// VolumeTooLarge (over `options.memoryBudgetBytes`; nothing was allocated), Internal where
/// cancelled. Source: Rauter et al. 2024, section 3; that values between two corners count is ours.
/// Tested by: partitioned_maps_test.cpp
Result<PartitionedMaps> buildPartitionedMaps(const TexelCodes& codes, ValueBins bins,
                                             const SkipOptions& options,
                                             const CancelToken* cancel = nullptr);

/// The least distance to any partition of the set; 255 where it is empty. No greater than in the
/// Chebyshev map of a TF whose visibleBins() these are, and the same where it shows whole
/// partitions. Cost: O(blocks * partitions in the set), all cores.
FreeLengths merged(const PartitionedMaps& maps, const BinSet& set);

} // namespace slabcast

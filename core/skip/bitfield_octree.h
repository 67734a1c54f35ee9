#pragma once

#include "core/skip/minmax_octree.h"
#include "core/skip/value_bins.h"

namespace slabcast {

/// Octree of the bins of values that occur, for any TF, with its bins: a TF is one set of them. A
/// node has every bin from a cell's least corner to its greatest.
struct BitfieldOctree {
    Octree octree;
    ValueBins bins;
};

/// Contract: 8, 16, 32, 64 or 128 bins. Cost: O(nodes), all cores. Source: Faludi et al. 2021,
/// sections 3.1 to 3.3; that values between two corners count is ours. Tested by: octree_test.cpp
BitfieldOctree bitfieldOctree(const Octree& minMax, ValueBins bins);

/// The same from the volume. Cost and failures: as buildMinMaxOctree().
Result<BitfieldOctree> buildBitfieldOctree(const TexelCodes& codes, ValueBins bins,
                                           const SkipOptions& options,
                                           const CancelToken* cancel = nullptr);

/// The bins in which the TF shows anything. Contract: 128 bins at most. Cost: O(codes).
NodeTest bitfieldNodeTest(const ValueBins& bins, const CellVisibility& visibility);

} // namespace slabcast

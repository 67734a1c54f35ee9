#pragma once

#include "platform/cli/skipbench_builds.h"

namespace slabcast {

/// Rauter et al. 2024, table 1: what a change of transfer function takes where distance maps are
/// rebuilt in full, rebuilt from the ranges of values that blocks keep, and merged from
/// partitioned maps, for its six transfer functions, block edges and numbers of partitions. All in
/// turn in every round. Rows of the table "rebuild" (chebyshev and proximity), "partitions" (one
/// time, memory, or refused) and "merge" (`speedup`: the full chebyshev rebuild's time over the
/// merge's, the median of rounds).
Result<void> measureMerging(SkipBench& bench, const Workshop& workshop);

} // namespace slabcast

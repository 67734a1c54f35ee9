#pragma once

#include "core/base/error.h"

namespace slabcast {
struct TransferFunction;
}

namespace slabcast::skipbench {

struct Bench;
class Workshop;

/// Rauter et al. 2024, table 1: what a change of transfer function takes where distance maps are
/// rebuilt in full, rebuilt from the ranges of values that blocks keep, and merged from
/// partitioned maps, for its six transfer functions (`other` is the sixth), block edges and numbers
/// of partitions. All in turn in every round. Adds rows of the tables Rebuild, Partitions and
/// Merge.
Result<void> measureMerging(Bench& bench, const Workshop& workshop, const TransferFunction& other);

} // namespace slabcast::skipbench

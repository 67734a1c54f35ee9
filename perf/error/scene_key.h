#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"
#include "perf/json.h"

namespace slabcast {

// What tells volumes and looks apart, in parts that keys are made of.

/// FNV-1a: equal content is told from other, no more is needed.
std::string fingerprint(std::span<const std::byte> bytes);

Json placementKey(const VolumeGeometry& geometry); // dimensions included
Json transferKey(const TransferFunction& tf);
Json statisticsKey(const VolumeStatistics& statistics);

} // namespace slabcast

#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"

namespace slabcast {

// What tells volumes and looks apart, in parts that keys are made of.

/// FNV-1a: equal content is told from other, no more is needed.
std::string fingerprint(std::span<const std::byte> bytes);

nlohmann::json placementKey(const VolumeGeometry& geometry); // dimensions included
nlohmann::json transferKey(const TransferFunction& tf);
nlohmann::json statisticsKey(const VolumeStatistics& statistics);

} // namespace slabcast

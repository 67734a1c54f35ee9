#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/gl/caps.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"
#include "perf/json.h"

namespace slabcast {

class Scene;
struct StageDesc;

// What tells volumes and looks apart, in parts that keys are made of.

/// FNV-1a: equal content is told from other, no more is needed.
std::string fingerprint(std::span<const std::byte> bytes);

Json placementKey(const VolumeGeometry& geometry); // dimensions included
Json transferKey(const TransferFunction& tf);
Json statisticsKey(const VolumeStatistics& statistics);

/// All that a frame's time depends on but the build: device, scene, view, picture and settings.
/// Cost: one pass over the texels. Tested by: ratio_table_test.cpp
Json frameKey(const gl::Caps& caps, const Scene& scene, const StageDesc& drawn);

} // namespace slabcast

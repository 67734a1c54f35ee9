#pragma once

#include <string>
#include <vector>

#include "core/plan/frame_plan.h"

namespace slabcast {

class Stage;

// What ratios of planes to layers took on this device, scene by scene: kept by device_cache.h as
// ratio-table, so that a run measures what no run before it has. A table that is damaged, or cannot
// be kept, is said and done without.

/// What ratios take, and a line on where that is from; both empty where the settings name a ratio.
struct FoundRatios {
    std::vector<RatioMeasurement> ratios;
    std::string origin;
};

/// From the table, or measured now and kept there. Fails: as Stage::timeRatios().
/// Tested by: cli_ratios_test.py
Result<FoundRatios> ratiosOf(Stage& stage, const Settings& settings);

/// Keeps what was measured of the stage's scene otherwise.
void keepRatios(const Stage& stage, const Settings& settings, std::vector<RatioMeasurement> ratios);

} // namespace slabcast

#pragma once

#include "perf/stability/bench.h"

namespace slabcast::stability {

// Parts of the stiff family.

/// TFs that change within one data unit: steps and spikes, seen through a ramp of values.
void stiffTransferCases(Bench& bench);
/// Media of one material per ray: opacity 1 and 1e-6, units of 1 nm and 1 km, twelve decades at
/// once.
void stiffMediumCases(Bench& bench);
/// Data that change from voxel to voxel: sheets, a checkerboard.
void stiffDataCases(Bench& bench);

} // namespace slabcast::stability

#pragma once

#include "perf/stability/bench.h"
#include "perf/stability/turning.h"

namespace slabcast::stability {

/// How much more than the integral a pixel changes while the view turns: of the float64 samples and
/// of what the device draws, on both lattices, with and without jitter, and per ratio.
void swimmingCases(Bench& bench, const Scene& scene, const TurningScene& setup,
                   const Motion& motion);

} // namespace slabcast::stability

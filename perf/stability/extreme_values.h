#pragma once

#include "perf/stability/bench.h"

namespace slabcast::stability {

/// The part of the extreme data that lies in the voxels' values.
void extremeValueCases(Bench& bench, glm::ivec2 size);

} // namespace slabcast::stability

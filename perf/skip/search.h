#pragma once

#include "perf/skip/frames.h"

namespace slabcast::skipbench {

/// Every structure with the parameters that draw the volume fastest by ray casting, as Faludi et
/// al. 2021, table 1, has them; none first. A grid of parameters is timed on a picture of half the
/// edge, marching only (the least of a few frames), then the best few of each structure race at
/// full size, without early exit and with it. Partitioned maps are not searched: what frames take
/// depends on the merged map alone. Adds rows of the tables Search and Finals.
Result<BestParameters> searchParameters(Bench& bench);

} // namespace slabcast::skipbench

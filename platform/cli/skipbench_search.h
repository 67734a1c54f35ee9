#pragma once

#include "platform/cli/skipbench_subject.h"

namespace slabcast {

/// Every structure with the parameters that draw the volume fastest by ray casting, marching only;
/// none first. A grid of parameters is timed on a picture of half the edge (the least of a few
/// frames), then the best few of each structure race at full size. Partitioned maps are not
/// searched: what frames take depends on the merged map alone. Adds rows of the tables "search" and
/// "finals".
Result<std::vector<SkipOptions>> searchParameters(SkipBench& bench);

} // namespace slabcast

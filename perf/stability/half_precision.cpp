#include "perf/stability/bench.h"

namespace slabcast::stability {

void halfPrecisionCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

#include "perf/stability/bench.h"

namespace slabcast::stability {

void leftOutCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

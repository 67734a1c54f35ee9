#include "perf/stability/bench.h"

namespace slabcast::stability {

void extremePlanCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

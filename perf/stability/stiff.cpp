#include "perf/stability/bench.h"

namespace slabcast::stability {

void stiffCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

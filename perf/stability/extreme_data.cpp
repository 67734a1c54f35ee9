#include "perf/stability/bench.h"

namespace slabcast::stability {

void extremeDataCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

#include "perf/stability/bench.h"

namespace slabcast::stability {

void extremeViewCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

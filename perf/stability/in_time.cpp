#include "perf/stability/bench.h"

namespace slabcast::stability {

void inTimeCases(Bench& /*bench*/) {}

} // namespace slabcast::stability

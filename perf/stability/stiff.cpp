#include "perf/stability/stiff.h"

namespace slabcast::stability {

void stiffCases(Bench& bench) {
    stiffTransferCases(bench);
    stiffMediumCases(bench);
    stiffDataCases(bench);
}

} // namespace slabcast::stability

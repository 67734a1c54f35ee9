#include "perf/stability/families.h"

namespace slabcast::stability {

std::span<const Family> families() {
    static constexpr Family kFamilies[] = {
        {"stiff", "Stiff transfer functions and data", stiffCases},
        {"extreme-data", "Extreme data", extremeDataCases},
        {"extreme-views", "Extreme views", extremeViewCases},
        {"extreme-plans", "Extreme plans", extremePlanCases},
        {"in-time", "Swimming in time", inTimeCases},
        {"lattices", "Planar layers or shells", latticeCases},
        {"half-precision", "Half precision", halfPrecisionCases},
        {"left-out", "What a scene does not need", leftOutCases},
        {"symmetry", "Axes, mirrors and units", symmetryCases},
        {"cut-rays", "A ray cut into pieces", cutRayCases},
        {"conditioning", "One ulp of an input", conditioningCases},
        {"optical-depth", "Optical depth from 1e-8 to 1e8", opticalDepthCases},
        {"manufactured", "Manufactured solutions", manufacturedCases}};
    return kFamilies;
}

} // namespace slabcast::stability

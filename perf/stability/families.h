#pragma once

#include <span>

namespace slabcast::stability {

class Bench;

/// Families of cases, each in a file of its own name.
void stiffCases(Bench& bench);
void extremeDataCases(Bench& bench);
void extremeViewCases(Bench& bench);
void extremePlanCases(Bench& bench);
void inTimeCases(Bench& bench);
void latticeCases(Bench& bench);
void halfPrecisionCases(Bench& bench);
void leftOutCases(Bench& bench);
void symmetryCases(Bench& bench);
void cutRayCases(Bench& bench);
void conditioningCases(Bench& bench);
void opticalDepthCases(Bench& bench);
void manufacturedCases(Bench& bench);

struct Family {
    const char* name;
    const char* title;
    void (*run)(Bench& bench);
};
std::span<const Family> families();

} // namespace slabcast::stability

#pragma once

#include <span>

namespace slabcast::skipbench {

/// Median of a[k] / b[k]: what makes both slower in one round, as a busy machine or another view
/// does, is in neither. Contract: as many of the one as of the other. Tested by:
/// figures_test.cpp
double pairedRatio(std::span<const double> a, std::span<const double> b);

} // namespace slabcast::skipbench

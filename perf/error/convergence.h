#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "perf/json.h"

namespace slabcast {

/// One level of a refinement. Sizes are what is refined: a step, a grid's or a pixel's edge.
struct RefinementLevel {
    double size = 0.0;
    double error = 0.0;             // RMSE against the truth
    std::optional<double> change{}; // RMSE against the level before; knows of no truth
};

/// How near an order must lie to the expected one, and the last three to each other: half way to
/// the next whole order would be 0.5.
inline constexpr double kOrderTolerance = 0.2;
/// So many refinements in a row must show the same order: two can agree by chance.
inline constexpr int kStableOrders = 3;

/// What a refinement shows.
struct Convergence {
    /// Per level, from the level before: p where the error went as size^p, and where the changes
    /// did. Nothing at the first levels and where an error is at the floor.
    std::vector<std::optional<double>> orders;
    std::vector<std::optional<double>> selfOrders;
    std::optional<double> order; // the last that is known
    /// By changes alone, as Richardson's ratio has it: log2 of one change over the next. Where it
    /// is not `order`, the method converges to something else than the truth.
    std::optional<double> selfOrder;
    bool asymptotic = false; // the last kStableOrders orders agree
    std::string why;         // it is or is not
};

/// `levels` from coarse to fine. `floor`: errors below it are not the method's. Pure.
/// Tested by: convergence_test.cpp
Convergence convergenceOf(std::span<const RefinementLevel> levels, double floor);

/// Whether it is asymptotic and of that order.
bool hasOrder(const Convergence& convergence, double expected);

/// `levels` (`size`, `rmse`, `change`, `order`, `self_order`), `order`, `self_order`, `asymptotic`
/// and `why`.
Json toJson(std::span<const RefinementLevel> levels, const Convergence& convergence);

/// Whether the sampling error of a report's rows falls with their spacing as it should: an entry
/// for each classification with and without jitter (what is sampled depends on nothing else), with
/// `expected_order`, `why_expected` and `as_expected`. `hasSteps`: of the transfer function.
Json familyConvergence(const Json& rows, bool hasSteps);

} // namespace slabcast

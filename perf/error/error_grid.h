#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perf/error/error_table.h"
#include "perf/json.h"

namespace slabcast {

/// What `slabcast error` varies. An empty axis stands for its default.
struct GridAxes {
    std::vector<double> spacings;    // of layers, voxels
    std::vector<int> layersPerPlane; // 0: all
    std::vector<Classification> classifications;
    std::vector<TargetFormat> targets;
    std::vector<std::optional<double>> terminations;
    std::vector<bool> jitter;
};

/// `given` with defaults where it is empty, fewer of them if `quick`; spacings from coarse to fine,
/// ray casting before other numbers of layers per plane. Tested by: error_grid_test.cpp
GridAxes completed(GridAxes given, bool quick);

/// Every combination; by classification, jitter and spacing first, which a sampled picture in
/// float64 depends on. If `quick`, the second and later values of termination and of jitter are
/// combined with one number of layers per plane only.
std::vector<Sampling> gridOf(const GridAxes& axes, bool quick);

/// Names a row: unique in a grid, fit for a file's name. Tested by: error_grid_test.cpp
std::string idOf(const Sampling& sampling);

Json toJson(const GridAxes& axes);
Json toJson(const std::optional<double>& termination); // a number or "off"
/// `rows` hold what the settings were: see toJson(Sampling).
Json toJson(const Sampling& sampling);

/// Adds `order` and `coarser` to every row: for each part of its error the exponent p with which
/// the error went as spacing^p from the family's next coarser row to this one. Null where there is
/// none, and where an error is at its floor: below 1e-9 (the references' own accuracy), or in the
/// total less than half due to sampling. Tested by: error_grid_test.cpp
void addOrders(Json& rows);

/// Indices of the rows that no other beats both in cost and in total RMSE, cheapest first; rows
/// without a cost are left out.
std::vector<std::size_t> frontOf(const Json& rows, std::optional<double> (*cost)(const Json& row));

double totalRmse(const Json& row);

} // namespace slabcast

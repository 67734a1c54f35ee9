#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perf/error/error_report.h"
#include "perf/error/error_store.h"

namespace slabcast {

/// Every row of the grid with a plan of its own, in order, measured or taken from the store; those
/// of a classification that cannot be had are left out, and `leftOut` receives why. Contract: the
/// store has the reference. Fails: InvalidArgument (none can be had), as what is measured.
Result<nlohmann::json> errorRows(Stage& stage, const ErrorDesc& desc,
                                 const std::vector<Sampling>& grid, ErrorStore& store,
                                 ReportFolder& folder, nlohmann::json& leftOut);

} // namespace slabcast

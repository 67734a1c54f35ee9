#pragma once

#include <vector>

#include "perf/error/error_report.h"
#include "perf/error/error_store.h"
#include "perf/json.h"

namespace slabcast {

/// Every row of the grid with a plan of its own, in order, measured or taken from the store; those
/// of a classification that cannot be had are left out, and `leftOut` receives why. Contract: the
/// store has the reference. Fails: InvalidArgument (none can be had), as what is measured.
Result<Json> errorRows(Stage& stage, const ErrorDesc& desc, const std::vector<Sampling>& grid,
                       ErrorStore& store, ReportFolder& folder, Json& leftOut);

} // namespace slabcast

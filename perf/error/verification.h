#pragma once

#include <vector>

#include "perf/error/error_report.h"

namespace slabcast {

/// Adds to a report with its rows what an expert asks of it before trusting it: `convergence` (does
/// this volume's sampling error fall as it must?) and `predicted_step`; with
/// ErrorDesc::verification also `refinement` (does what is measured find the orders that theory
/// has, and find mistakes?) and `worst_ray`, else null, and the files refinement.csv,
/// worst_ray.json and worst_ray.csv. What cannot be had of the device is said in `refinement`'s
/// `device_refused`. Changes the stage's classification. Fails: as traceWorstRay() and the folder.
/// Tested by: cli_error_test.py
Result<void> addVerification(Stage& stage, const ErrorDesc& desc, const std::vector<Sampling>& grid,
                             ReportFolder& folder, Json& report);

} // namespace slabcast

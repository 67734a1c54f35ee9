#pragma once

#include <functional>
#include <string>
#include <vector>

#include "perf/error/error_grid.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

/// A line that draws the picture of a row again, into `file`, for people to copy; may be empty.
using CommandOf = std::function<std::string(const Sampling& sampling, const FramePlan& plan,
                                            const std::string& file)>;

struct ErrorDesc {
    GridAxes axes; // completed()
    bool quick = false;
    int frames = 5;            // of a row, at most
    bool verification = false; // refinement and the worst ray, too
    CommandOf commandOf;
};

/// The folder that the report's pictures are in, to be there before.
inline constexpr const char* kErrorPictures = "pictures";

/// How far the pictures of every row of the grid are from the continuous model, split into what
/// sampling, the transfer function's table and the GPU add, and what they take. Writes error.json,
/// error.csv, pictures and what addVerification() writes, and keeps what is finished in the
/// folder's ErrorStore as it goes. Gives what it measured, for an error table. Contract:
/// StageDesc::keepValues, a transparent background and frames >= kFewestFrames. Fails:
/// InvalidArgument (no classification can be had), as the stage and the folder. Tested by:
/// cli_error_test.py
Result<std::vector<MeasuredError>> measureErrors(Stage& stage, const ErrorDesc& desc,
                                                 const RunInfo& run, ReportFolder& folder);

} // namespace slabcast

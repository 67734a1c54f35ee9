#pragma once

#include <string>
#include <vector>

#include "perf/error/error_table.h"
#include "perf/json.h"
#include "perf/report_folder.h"
#include "perf/stage.h"

namespace slabcast {

/// The pixel of a picture that is farthest from the reference in any of R, G, B: `pixel` (from the
/// lower left), `picture` and `reference` (premultiplied RGBA), `error`.
Json worstPixel(const std::vector<glm::dvec4>& picture, const std::vector<glm::dvec4>& reference,
                glm::ivec2 size);

/// The row whose worst ray is looked at: of the post-classified rows with the spacing nearest to
/// one voxel the most accurate; null of none.
const Json* rowToTrace(const Json& rows);

/// Traces that row's worst ray in float64 beside the exact integral and writes worst_ray.json and
/// worst_ray.csv, a line per layer. Gives a report's `worst_ray`: what is in the JSON file but its
/// layers; null where no row is post-classified. Changes the stage's classification.
/// Fails: as Stage::reclassify(), Stage::plan() and the folder. Tested by: cli_error_test.py
Result<Json> traceWorstRay(Stage& stage, const std::vector<Sampling>& grid, const Json& rows,
                           ReportFolder& folder);

} // namespace slabcast

#pragma once

#include <span>

#include "perf/json.h"
#include "perf/model/predict.h"

namespace slabcast {

/// By GPU, what a model says of it; nothing of this was measured. docs/reports.md has the keys.
/// Tested by: cli_model_test.py, cli_reports_test.py
Json toJson(std::span<const Prediction> predictions);

} // namespace slabcast

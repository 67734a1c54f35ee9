#pragma once

#include <string>

#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "perf/watcher.h"

namespace slabcast::stability {

class Bench;

/// The folder that the report's pictures are in, to be there before.
inline constexpr const char* kPictures = "pictures";

/// Runs the cases of the family of this name, of all where it is empty, and writes stability.json,
/// stability.csv and pictures. Cases that exceed their bounds are for verdict() to tell. Fails: as
/// the folder. Tested by: stability_test.py
Result<void> measure(Bench& bench, const std::string& family, const RunInfo& run,
                     ReportFolder& folder, const Watcher& watcher);

} // namespace slabcast::stability

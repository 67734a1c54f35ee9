#pragma once

#include <vector>

#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

struct SweepDesc {
    std::vector<int> layersPerPlane; // 0 stands for all: ray casting; empty: the lengths that can
                                     // be written out, and 0
    int frames = 12;                 // of one turn, per row
};

/// Folders that the report's pictures are in, to be there before.
inline constexpr const char* kSweepThumbnails = "thumbnails";

/// Measures every ratio under the stage's settings: the plain stack, then what skipping and tight
/// planes add to it, a turn of the volume each. Writes sweep.json and sweep.csv, and a thumbnail
/// per row. Fails: as Stage::prepare(), Stage::drawTimed() and the folder.
/// Tested by: cli_usage_test.py
Result<void> sweep(Stage& stage, const SweepDesc& desc, const RunInfo& run, ReportFolder& folder);

/// The settings of every row, in order. Pure. Tested by: heatmap_test.cpp
std::vector<Settings> sweepRows(const Settings& settings, const SceneFacts& facts,
                                std::vector<int> layersPerPlane);

} // namespace slabcast

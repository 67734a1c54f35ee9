#pragma once

#include <vector>

#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

struct SweepDesc {
    std::vector<int> layersPerPlane; // 0 stands for all: ray casting; empty: the lengths that can
                                     // be written out, and 0
    int rounds = 12;                 // of one turn, in each of which every row draws a frame
};

/// Folders that the report's pictures are in, to be there before.
inline constexpr const char* kSweepThumbnails = "thumbnails";

/// Measures every ratio under the stage's settings: the plain stack, then what skipping and tight
/// planes add to it. All rows race (race.h): what a busy machine does hits all alike. Writes
/// sweep.json and sweep.csv, and a thumbnail per row; a run cut short goes on after its last whole
/// round. Returns what ratios take, the medians, of those rows that are drawn as the stage's own
/// settings are at their ratio. Fails: as Stage::prepare(), Stage::drawTimed(), RunStore::open()
/// and the folder. Tested by: cli_reports_test.py
Result<std::vector<RatioMeasurement>> sweep(Stage& stage, const SweepDesc& desc, const RunInfo& run,
                                            ReportFolder& folder);

/// One row: how it is drawn, and which of the series it is of, the plain stack being the first.
struct SweepRow {
    Settings settings;
    int series = 0;
};

/// Every row, in order. Pure. Tested by: heatmap_test.cpp
std::vector<SweepRow> sweepRows(const Settings& settings, const SceneFacts& facts,
                                std::vector<int> layersPerPlane);

} // namespace slabcast

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/plan/frame_plan.h"
#include "core/skip/live_skip.h"
#include "perf/edit/writer.h"

namespace slabcast {

class Stage;
struct RunInfo;

/// What ratios take in a stage's scene where the settings leave them open.
using RatioSource =
    std::function<Result<std::vector<RatioMeasurement>>(Stage& stage, const Settings& settings)>;

/// What is edited, and how it is drawn meanwhile.
struct EditDesc {
    EditScript script;
    std::string origin = "usual";   // of the script: usual, interpolation or script; for the report
    Settings settings;              // the ratio is decided once, under the script's first TF
    RatioSource ratios{};           // that it goes by; empty: measured now
    LiveOptions live;               // how empty space is skipped meanwhile
    double turnDegrees = 0.0;       // of the volume, over all frames
    double workBudgetMs = 2.0;      // for a frame's share of rebuilding, at most
    std::optional<double> budgetMs; // what a frame may take; none: by the octree's
    int octreeFrames = 3;           // that each frame is measured against
    int replays = 1;
    bool verify = false; // compare each picture, bit for bit, with one from scratch
};

/// As files hold it; docs/reports.md has the keys.
struct EditReport {
    std::string json;
    std::string csv;
    int frames = 0;
    int wrongFrames = 0; // of those that were compared
};

/// Replays edits of the transfer function and, frame by frame, what they are measured against.
/// `stage`: opened without skipping and without tight planes, since the scenes that are edited have
/// what they need. Tells the stage's watcher how far it is. Fails: InvalidArgument (pre-classified
/// texels hold the transfer function; a structure that cannot serve), and as plan() and the
/// renderer. Contract: frames, octreeFrames and replays of 1 or more. Tested by: edit_test.py
Result<EditReport> replayEdits(Stage& stage, const EditDesc& desc, const RunInfo& run);

} // namespace slabcast

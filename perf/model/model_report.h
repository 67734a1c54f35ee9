#pragma once

#include <vector>

#include "perf/model/paper_sampling.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"

namespace slabcast {

struct ModelDesc {
    std::vector<int> layersPerPlane; // 0: all; empty: the lengths that can be written out, and 0
    PaperVolume paper;               // the volume as a cube of 256^3 under its transfer function
};

/// What a model says of headsets that are not at hand, and how far it is from the core paper's own
/// figures: model.json. Every ratio is drawn once here, at a headset's eye buffers and by the plan
/// that it would get, and its work counted. Returns lines for people. Fails: as Stage::prepare(),
/// Stage::workPerPixel() and the folder. Contract: the stage has two eyes. Tested by:
/// cli_model_test.py
Result<std::vector<std::string>> modelReport(Stage& stage, const ModelDesc& desc,
                                             const RunInfo& run, ReportFolder& folder);

} // namespace slabcast

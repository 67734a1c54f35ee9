#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/reference/picture_difference.h"
#include "perf/heatmap.h"
#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

/// What is drawn once the stage is prepared for a plan, and what it took. Tested by:
/// cli_pictures_test.py, heatmap_test.py

/// The volume turned once around.
struct Turn {
    std::vector<double> frameMs;
    std::vector<glm::vec4> firstPicture; // Stage::picture(encoded)
};
Result<Turn> drawTurn(Stage& stage, const FramePlan& plan, int frames, bool encoded);

/// How far the first frame is from the exact picture, which takes a while. Contract:
/// StageDesc::keepValues.
Result<PictureDifference> errorOf(Stage& stage, const FramePlan& plan);

/// The first frame's cost, pixel by pixel.
struct CostPicture {
    std::vector<glm::vec4> pixels; // top row first, sRGB-encoded if asked for, else light
    HeatmapQuantity quantity = HeatmapQuantity::Iterations;
    double maximum = 0.0; // of the last colour
    double sum = 0.0;
};
Result<CostPicture> drawCosts(Stage& stage, const FramePlan& plan, HeatmapQuantity quantity,
                              const HeatmapScale& scale, bool encoded);

/// What was found out about the frame, beside its times. `render --stats` writes it.
struct FrameFindings {
    std::vector<double> frameMs;
    std::optional<PictureDifference> error{};
    const CostPicture* costs = nullptr;
};
/// As JSON; keys are stable: people plot them.
std::string frameReport(Stage& stage, const FramePlan& plan, const Settings& settings,
                        const FrameFindings& findings, const RunInfo& run);

} // namespace slabcast

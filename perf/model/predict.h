#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/draw/renderer_api.h"
#include "perf/model/frame_model.h"

namespace slabcast {

class Stage;

/// What a model says of one way to draw on a GPU that is not at hand.
struct Prediction {
    const GpuRates* gpu = nullptr;
    FramePlan plan; // as that GPU would get it: its shader is what is reckoned with
    FrameWork work;
    ModelTerms terms;
};

/// Of all GPUs whose compiler's table has the shader that they would draw these settings with: the
/// stage's scene and view. `work`: of the picture's pixels (Stage::workPerPixel()), drawn here with
/// the same layers per plane; what other plans evaluate or skip differs little. Contract: as many
/// as the picture has. Fails: as slabcast::plan(). Tested by: cli_reports_test.py
Result<std::vector<Prediction>> predictions(const Stage& stage, const Settings& settings,
                                            std::span<const PixelWork> work);

/// The plan that a GPU would get.
Result<FramePlan> planOn(const GpuRates& gpu, const Stage& stage, const Settings& settings);

} // namespace slabcast

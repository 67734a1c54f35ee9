#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/draw/renderer_api.h"

namespace slabcast {

/// Draws the candidate ratios of these views, at a quarter of their size, from ray casting to
/// slicing, and times them; stops at the first that is hopelessly slower than the best, so that no
/// device is held up by what it will never use. Compiles what it measures and waits for the GPU:
/// for start-up or a loading screen. The result is an input of plan(). `nowMs` is a clock that runs
/// evenly; tests hand in one of their own. Tested by: renderer_work_gl_test.cpp
Result<std::vector<RatioMeasurement>> measureRatios(Renderer& renderer, const Scene& scene,
                                                    const Settings& settings, const gl::Caps& caps,
                                                    std::span<const ViewTarget> views,
                                                    const std::function<double()>& nowMs = {});

} // namespace slabcast

#pragma once

#include <span>
#include <vector>

#include "core/frame/renderer.h"

namespace slabcast {

/// Draws every candidate ratio of these views, at a quarter of their size, and times it: the median
/// of a few frames after one to warm up. Compiles what it measures. Waits for the GPU: for start-up
/// or a loading screen. The result is an input of plan(). Tested by: renderer_gl_test.cpp
Result<std::vector<RatioMeasurement>> measureRatios(Renderer& renderer, const Scene& scene,
                                                    const Settings& settings, const gl::Caps& caps,
                                                    std::span<const ViewTarget> views);

} // namespace slabcast

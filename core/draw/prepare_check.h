#pragma once

#include <span>

#include "core/draw/renderer_api.h"

namespace slabcast {

/// Whether draw() can draw this plan of this scene: made for its look of now, of what was provided
/// for it, skipping by what serves. Allocates nothing where it can. Fails: InvalidArgument, with
/// what to do. Tested by: scene_gl_test.cpp
Result<void> checkPlan(const FramePlan& plan, const Scene& scene);

/// check() of every view that is not empty, and whether its layer can be one. Fails:
/// InvalidArgument, naming the view by its index. Tested by: scene_gl_test.cpp, views_gl_test.cpp
Result<void> checkViews(std::span<const ViewTarget> views);

} // namespace slabcast

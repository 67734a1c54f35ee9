#pragma once

#include <span>

#include "core/draw/renderer_api.h"

namespace slabcast {

/// Draws a pixel in every way that edits of the scene's TF may lead to, into a target of its own:
/// with each structure that may come to serve, or none where nearly all is visible; as thin or as
/// dense as can be. Drivers put compiling off until a program is first drawn with; after this none
/// is left for a frame to wait for, nor a layer or a structure's texture to be allocated.
/// `settings`, `measurements`: as plan() will be given them; `views`: in whose way is drawn.
/// Restores the GL state (gl::StateGuard). Fails: as plan() and Renderer::prepare(). Tested by:
/// live_editing_gl_test.cpp
Result<void> warmUpForEditing(Renderer& renderer, const LiveScene& scene, const Settings& settings,
                              const gl::Caps& caps, std::span<const RatioMeasurement> measurements,
                              std::span<const ViewTarget> views);

} // namespace slabcast

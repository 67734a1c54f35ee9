#pragma once

#include "core/gl/api.h"
#include "core/plan/frame_plan.h"

namespace slabcast {

/// Blending by these factors and nothing else of what GL does to fragments, whatever was enabled:
/// no test, no mask, no culling. What is drawn or cleared after this is drawn as it is.
void useBlending(GLenum source, GLenum destination);

/// Planes over what is there, or under it.
void usePlaneBlending(BlendOrder order);

} // namespace slabcast

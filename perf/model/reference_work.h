#pragma once

#include <optional>
#include <span>

#include "core/plan/frame_plan.h"
#include "perf/model/frame_model.h"

namespace slabcast {

/// Two volumes that were counted once, at the eye buffers of a headset (reference.py): the demo's
/// skull, most of which is skipped, and one of which all is visible.
enum class ReferenceScene : std::uint8_t { Skull, Full };

/// Of known ratios: layers per plane that a model finds fastest on a GPU; 0 where that is all of
/// them on one plane, nothing where the compilers' figures lack the shaders. core/plan/known_gpus.h
/// holds what this gives. Tested by: known_gpus_test.cpp
std::optional<int> bestLayersPerPlane(const GpuRates& gpu, ReferenceScene scene);

} // namespace slabcast

#pragma once

#include <functional>
#include <span>

#include <glm/glm.hpp>

#include "core/draw/renderer_api.h"

namespace slabcast {

/// How many times as much of `amount` a picture's waves do as its pixels ask for: all of a wave do
/// what its busiest pixel does, and the idle ones at an edge, too. Counted on whole rays: where one
/// pixel works on one plane and its neighbour on another, waves do more still. 1 of nothing.
/// `work`: rows of `size`. Pure. Tested by: divergence_test.cpp
double divergence(std::span<const PixelWork> work, glm::ivec2 size, glm::ivec2 wave,
                  const std::function<double(const PixelWork&)>& amount);

} // namespace slabcast

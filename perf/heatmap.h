#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "core/draw/renderer.h"

namespace slabcast {

/// What of a pixel's work a heatmap shows. Iterations are looks at the skip structure and layers
/// evaluated; fetches are of the volume and of the skip structure.
enum class HeatmapQuantity : std::uint8_t { Iterations, Fetches, Layers };

const char* name(HeatmapQuantity quantity);
double costOf(const PixelWork& work, HeatmapQuantity quantity);

/// Which cost has the last colour: the picture's most, the layers that there are in all, or a
/// number.
struct HeatmapScale {
    bool absolute = false;
    std::optional<double> maximum;
};

/// Of costs from 0 to `mostLayers` or more.
double maximumOf(const HeatmapScale& scale, const std::vector<double>& costs, int mostLayers);

/// Black, purple, orange, yellow, white: sRGB-encoded, for a part from 0 to 1. Lightness (CIELAB's
/// L*) grows in proportion to the part, so that equal steps of cost look alike, and what is
/// brighter costs more also for those who see no hue.
glm::vec3 heatColor(double part);

/// The costs as colours, top row first, with a scale at the bottom: what is shown, 0, the colours,
/// and the maximum. sRGB-encoded.
std::vector<glm::vec4> drawHeatmap(glm::ivec2 size, const std::vector<double>& costs,
                                   HeatmapQuantity quantity, double maximum);

} // namespace slabcast

#pragma once

#include <glm/glm.hpp>

namespace slabcast {

/// A headset as applications draw for it unless they ask for more.
struct Headset {
    const char* name;
    const char* gpu;      // of gpu_rates.h
    glm::ivec2 eyePixels; // of one eye's buffer
    const char* source;   // of those
};

/// Of frames a second that they show.
inline constexpr double kHeadsetRates[] = {72.0, 90.0};

inline constexpr Headset kHeadsets[] = {
    {"Quest 2",
     "adreno650",
     {1440, 1584},
     "the default as commonly reported; no document of Meta's was at hand"},
    {"Quest 3", "adreno740", {1680, 1760}, "github.com/StereoKit/StereoKit/discussions/926"},
    {"Galaxy S8", "g71", {1480, 1440}, "the core paper's phone: Tukora 2020, section 3"},
};

} // namespace slabcast

#pragma once

#include <span>

#include "platform/cli/skipbench_subject.h"

namespace slabcast {

/// What a row's frames do, as in Faludi et al. 2021, table 1: each adds to the one before.
struct BenchMode {
    const char* name;
    bool terminates;
    bool shaded;
};
inline constexpr BenchMode kMarchingOnly{"marching only", false, false};
inline constexpr BenchMode kEarlyExit{"early exit", true, false};
inline constexpr BenchMode kShading{"shading", true, true};

/// The same lattice, target and classification for all that is compared; planes are those of the
/// whole sphere, so that structures differ in nothing but what they skip.
Settings settingsOf(const SkipbenchOptions& options, const BenchMode& mode);
Settings rayCasting(const SkipbenchOptions& options, const BenchMode& mode);

/// Of a picture on which many choices are tried: half the edge.
glm::ivec2 smaller(glm::ivec2 size);

/// Frame times and work of all subjects: ray casting in every mode, hybrid at the best ratio of
/// each, slicing; the last two with planes of the whole sphere, and as rectangles around what is
/// visible. Adds rows of the tables "frames", "ratios" and "work" (of the usual parameters, equal
/// for all).
Result<void> measureFrames(SkipBench& bench, std::span<const Subject> subjects);

} // namespace slabcast

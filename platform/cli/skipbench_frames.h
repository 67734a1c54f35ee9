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

/// What suits rays that go on, and what suits those that end at opaque material.
template <class T>
struct ByMode {
    T marching;
    T terminating;

    const T& of(const BenchMode& mode) const { return mode.terminates ? terminating : marching; }
};
using BestParameters = ByMode<std::vector<SkipOptions>>;
using BestSubjects = ByMode<std::vector<Subject>>;

/// The same lattice, target and classification for all that is compared; planes of the whole
/// sphere, unless changed, so that structures differ in nothing but what they skip.
Settings settingsOf(const SkipbenchOptions& options, const BenchMode& mode);
Settings rayCasting(const SkipbenchOptions& options, const BenchMode& mode);

/// Of a picture on which many choices are tried: half the edge.
glm::ivec2 smaller(glm::ivec2 size);

/// A race of all subjects by ray casting; `row` is the beginning of each row.
Result<nlohmann::json> raceRays(SkipBench& bench, std::span<const Subject> subjects,
                                const BenchMode& mode, const nlohmann::json& row, int rounds,
                                double budgetMs);

/// Frame times and work of all subjects: ray casting in every mode, hybrid at the best ratio of
/// each, slicing; the last two with planes of the whole sphere, and as rectangles around what is
/// visible. Adds rows of the tables "frames", "ratios" and "work" (of the usual parameters, equal
/// for all).
Result<void> measureFrames(SkipBench& bench, const BestSubjects& subjects);

} // namespace slabcast

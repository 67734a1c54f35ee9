#pragma once

#include <span>

#include "perf/skip/subject.h"

namespace slabcast::skipbench {

/// What suits rays that go on, and what suits those that end at opaque material.
template <class T>
struct ByMode {
    T marching;
    T terminating;

    const T& of(const Mode& mode) const { return mode.terminates ? terminating : marching; }
};
using BestParameters = ByMode<std::vector<SkipOptions>>;
using BestSubjects = ByMode<std::vector<Subject>>;

/// Of the stage's settings, for ray casting.
Settings rayCasting(const Desc& desc, const Mode& mode);

/// Of a picture on which many choices are tried: half the edge.
glm::ivec2 smaller(glm::ivec2 size);

/// A race of all subjects by ray casting; `beginning` of each row, whose options are the subject's.
Result<std::vector<Row>> raceRays(Bench& bench, std::span<const Subject> subjects, const Mode& mode,
                                  const Row& beginning, int rounds, double budgetMs);

/// Frame times and work of all subjects: ray casting in every mode, hybrid at the best ratio of
/// each, slicing; the last two with planes of the whole sphere, and as rectangles around what is
/// visible. Adds rows of the tables Frames, Ratios and Work (of the usual parameters, equal for
/// all).
Result<void> measureFrames(Bench& bench, const BestSubjects& subjects);

} // namespace slabcast::skipbench

#pragma once

#include <span>

#include "perf/skip/bench.h"

namespace slabcast::skipbench {

struct Figure;
struct Row;
struct VolumeRecord;

/// What a run measured, beside what it was asked for.
struct Measured {
    std::span<const VolumeRecord> volumes;
    std::span<const Row> rows;
    std::span<const Figure> figures;
};

/// skipbench.json, and of its rows skipbench.csv. Keys are stable: people plot them.
Report reportOf(const Desc& desc, const Measured& measured, const RunInfo& info,
                const gl::Caps& caps);

} // namespace slabcast::skipbench

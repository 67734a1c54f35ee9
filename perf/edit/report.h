#pragma once

#include "perf/edit/replay.h"
#include "perf/edit/row.h"

namespace slabcast {

/// One structure that was built, and what it took: the last time, or never where 0.
struct EditBuild {
    SkipStructure structure = SkipStructure::None;
    int blockEdge = 0;
    double ms = 0.0;
    std::int64_t gpuBytes = 0;
};

struct EditBuilds {
    EditBuild always;                 // right under any TF
    std::optional<EditBuild> settled; // of one TF, where one is used
    double naiveMs = 0.0;             // all, for the last TF
};

/// What replays measured.
struct EditMeasured {
    const FramePlan& decided; // its ratio is all frames'
    const EditBuilds& builds;
    const EditReplays& replays;
};

/// edit.json, and of its rows edit.csv. Keys are stable: people plot them.
EditReport editReportOf(const Stage& stage, const EditDesc& desc, const EditMeasured& measured,
                        const RunInfo& run);

} // namespace slabcast

#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "perf/run_store.h"
#include "perf/skip/bench.h"
#include "perf/skip/row.h"

namespace slabcast::skipbench {

/// A volume on the bench: what its tables are measured with, and what came of it.
struct Bench {
    Stage& stage;
    const Desc& desc;
    std::string volume; // as its rows name it
    ProgressLine& progress;
    RunStore& store;         // what is finished already
    std::vector<Row> rows{}; // of all tables

    Row row(Table table, const SkipOptions& options) const {
        return {.table = table, .volume = volume, .options = options};
    }
    void add(std::vector<Row> more);
    /// A time, ms, that `measure` finds out unless the store has it.
    Result<double> timed(const std::string& id,
                         const std::function<Result<double>()>& measure) const;
    void show(const std::string& step) const { progress.show(volume + ": " + step); }
};

/// A skip structure with its parameters, built under the bench's transfer function; or none.
struct Subject {
    SkipOptions options;
    Scene scene;
};

/// Every structure with usual parameters: blocks or leaves of 4 voxels, 32 bits, 64 partitions.
std::vector<SkipOptions> usualStructures(const Desc& desc);

/// A subject for each of the structures but those that are over their memory budget.
Result<std::vector<Subject>> subjectsOf(const Stage& stage,
                                        std::span<const SkipOptions> structures);

} // namespace slabcast::skipbench

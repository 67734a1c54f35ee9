#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/options.h"
#include "platform/cli/progress.h"

namespace slabcast {

/// A volume on the bench: what its tables are measured with, and what came of it.
struct SkipBench {
    Stage& stage;
    const SkipbenchOptions& options;
    std::string volume; // as its rows name it
    Progress& progress;
    nlohmann::json rows = nlohmann::json::array(); // of all tables, told apart by "table"

    nlohmann::json row(const char* table) const { return {{"table", table}, {"volume", volume}}; }
};

/// A skip structure with its parameters, built under the bench's transfer function; or none.
struct Subject {
    SkipOptions options;
    Scene scene;
};

/// Structure and parameters, as rows hold them: no others than the structure's own.
nlohmann::json toJson(const SkipOptions& options);

/// Parameters that a search tries, for a volume of these dims; alike ones once.
std::vector<SkipOptions> searchGrid(SkipStructure structure, glm::ivec3 dims, bool quick);

/// Every structure with usual parameters: blocks or leaves of 4 voxels, 32 bits, 64 partitions.
std::vector<SkipOptions> usualStructures(const SkipbenchOptions& options);

/// What cannot be had, and why.
struct Refusal {
    SkipOptions options;
    Error error;
};

/// A subject for each of the structures but those that are over their memory budget: `refused` gets
/// these.
Result<std::vector<Subject>> subjectsOf(const Stage& stage,
                                        const std::vector<SkipOptions>& structures,
                                        std::vector<Refusal>& refused);

} // namespace slabcast

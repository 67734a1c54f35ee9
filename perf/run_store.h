#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "perf/json.h"
#include "perf/report_folder.h"
#include "perf/watcher.h"

namespace slabcast {

/// A run, as its folder knows it.
struct RunIdentity {
    std::string report;  // of kReports
    std::string subject; // for people: what is measured
    std::string command; // as it was typed; for people
    Json key{};          // all that its pieces depend on, `commit` among it; null: cannot go on
};

/// The reports that a folder may hold; NAME.json is what a finished run wrote last.
inline constexpr const char* kReports[] = {"sweep", "error",     "skipbench",
                                           "edit",  "stability", "model"};

/// Whether a run may write into a folder, for a run that cannot go on: none may be there, unless
/// the folder may be replaced (then what that run left is removed). Fails: FileUnwritable, naming
/// what the folder holds. Tested by: run_store_test.cpp, cli_reports_test.py
Result<void> claim(ReportFolder& folder, const RunIdentity& run);

/// What a run has finished, kept in its folder so that one cut short can go on: `rows.jsonl`, first
/// what the run is, then a finished piece a line, each an object with an `id`. What a piece is, the
/// run decides. Tested by: run_store_test.cpp
class RunStore {
public:
    /// Whether a line is what the run wrote: an object with an `id` it is already.
    using Sound = std::function<bool(const Json& piece)>;

    /// Goes on where the folder holds a run of an equal key, whose commit names its sources; starts
    /// where it holds none, and where it may be replaced. Pieces that are damaged are left out, all
    /// of them: the run starts anew. The watcher hears what came of it. Borrows the folder. Fails:
    /// FileUnwritable, where it holds anything else, which stays as it is.
    static Result<RunStore> open(ReportFolder& folder, RunIdentity run, const Watcher& watcher,
                                 const Sound& isSound = {});

    /// Whether an earlier run is gone on with.
    bool goesOn() const { return goesOn_; }

    /// Says what the folder holds, before anything else is written there. Fails: as the folder.
    Result<void> begin();
    /// Null where it is not finished.
    const Json* find(const std::string& id) const;
    /// Replaces one of the same id. Contract: it has an `id`. Fails: as the folder.
    Result<void> add(Json piece);

private:
    RunStore(ReportFolder& folder, RunIdentity run) : folder_(&folder), run_(std::move(run)) {}
    /// Of the file's lines after the first. False where one is damaged; what the last line was cut
    /// short in is left out.
    bool take(std::string_view lines, const Sound& isSound);
    Result<void> write();

    ReportFolder* folder_;
    RunIdentity run_;
    std::map<std::string, Json> pieces_;
    bool goesOn_ = false;
};

} // namespace slabcast

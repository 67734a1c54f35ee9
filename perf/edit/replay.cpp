#include "perf/edit/replay.h"

#include <algorithm>

#include "perf/edit/bench.h"
#include "perf/edit/report.h"
#include "perf/edit/summary.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

/// The plan under the script's first TF; its ratio is all frames'.
Result<FramePlan> decide(Stage& stage, const EditDesc& desc) {
    Settings settings = desc.settings;
    settings.skip.reset();
    Result<Scene> first = stage.variation(desc.script.start, desc.live.settled);
    if (!first) {
        return tl::unexpected(first.error());
    }
    stage.show(std::move(*first));
    const Result<std::vector<RatioMeasurement>> ratios =
        desc.ratios ? desc.ratios(stage, settings) : stage.timeRatios(settings);
    const Result<FramePlan> decided =
        ratios ? stage.decide(settings, *ratios) : tl::unexpected(ratios.error());
    FramePlan nothing;
    nothing.look = stage.scene().lookGeneration();
    nothing.drawsNothing = true; // lets the stage's textures go, where ratios were measured
    return stage.renderer().prepare(stage.scene(), nothing, {}).and_then([&] { return decided; });
}

Result<std::vector<EditRow>> replayAll(EditBench& bench, const Watcher& watcher,
                                       const EditDesc& desc, std::size_t replay) {
    std::vector<EditRow> rows;
    ProgressLine progress(watcher);
    const std::size_t count = desc.script.frames.size();
    for (const EditFrame& frame : desc.script.frames) {
        progress.show("replay " + std::to_string(replay + 1) + " of " +
                      std::to_string(desc.replays) + ", frame " + std::to_string(rows.size() + 1) +
                      " of " + std::to_string(count) + ": " + frame.step);
        const double turn =
            desc.turnDegrees * static_cast<double>(rows.size()) / static_cast<double>(count);
        Result<EditRow> row = bench.replay(frame, turn);
        if (!row) {
            return tl::unexpected(row.error());
        }
        rows.push_back(std::move(*row));
    }
    return rows;
}

} // namespace

Result<EditReport> replayEdits(Stage& stage, const EditDesc& desc, const RunInfo& run) {
    SLABCAST_EXPECTS(desc.replays >= 1, desc.replays);
    SLABCAST_EXPECTS(desc.octreeFrames >= 1, desc.octreeFrames);
    SLABCAST_EXPECTS(!desc.script.frames.empty(), desc.script.frames.size());
    const Result<FramePlan> decided = decide(stage, desc);
    if (!decided) {
        return tl::unexpected(decided.error());
    }
    EditReplays replays;
    EditBuilds builds;
    while (replays.size() < static_cast<std::size_t>(desc.replays)) {
        Result<EditBench> bench = EditBench::open(stage, desc, *decided);
        if (!bench) {
            return tl::unexpected(bench.error());
        }
        Result<std::vector<EditRow>> rows =
            replayAll(*bench, stage.watcher(), desc, replays.size());
        if (!rows) {
            return tl::unexpected(rows.error());
        }
        builds = bench->builds();
        replays.push_back(std::move(*rows));
    }
    return editReportOf(stage, desc, {*decided, builds, replays}, run);
}

} // namespace slabcast

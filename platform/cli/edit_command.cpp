#include <algorithm>
#include <filesystem>

#include <fmt/core.h>

#include "perf/csv.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "platform/cli/commands.h"
#include "platform/cli/edit_summary.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"
#include "platform/cli/skip_options.h"
#include "platform/cli/transfer_choice.h"
#include "platform/io/atomic_file.h"
#include "platform/json/json_checks.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The start is the script's own, or what --tf says.
Result<EditScript> scriptOf(const EditOptions& options, const Stage& stage) {
    const Scene& scene = stage.scene();
    const TransferSubject subject{scene.statistics(), stage.info().unit};
    const TransferByName byName = [&](const std::string& name) {
        return chooseTransferFunction(name, subject, stage.info().modality);
    };
    if (!options.scriptFile.empty()) {
        return readText(options.scriptFile, "script").and_then([&](const std::string& text) {
            return parseEditScript(text, fs::path(options.scriptFile).filename().string(), byName,
                                   subject);
        });
    }
    if (!options.interpolate) {
        return usualScript(scene.look().tf, scene.statistics(), options.frames);
    }
    const auto& [first, second] = *options.interpolate;
    return byName(first).and_then([&, &nameOfSecond = second](const TransferFunction& a) {
        return byName(nameOfSecond).map([&](const TransferFunction& b) {
            return interpolation(a, b, options.frames);
        });
    });
}

/// The plan under the script's first TF; its ratio is all frames'.
Result<FramePlan> decide(Stage& stage, const EditScript& script, const LiveOptions& live,
                         Settings settings) {
    settings.skip.reset();
    Result<Scene> first = stage.variation(script.start, live.settled);
    if (!first) {
        return tl::unexpected(first.error());
    }
    stage.show(std::move(*first));
    Result<FramePlan> decided = stage.decide(settings);
    FramePlan nothing;
    nothing.drawsNothing = true; // lets the stage's textures go, where ratios were measured
    return stage.renderer().prepare(stage.scene(), nothing, {}).and_then([&] { return decided; });
}

Result<std::vector<EditRow>> replayAll(EditBench& bench, const EditScript& script,
                                       const EditOptions& options, int replay) {
    std::vector<EditRow> rows;
    Progress progress;
    const auto count = script.frames.size();
    for (const EditFrame& frame : script.frames) {
        progress.show(fmt::format("replay {} of {}, frame {} of {}: {}", replay + 1,
                                  options.replays, rows.size() + 1, count, frame.step));
        const double turn =
            options.turnDegrees * static_cast<double>(rows.size()) / static_cast<double>(count);
        Result<EditRow> row = bench.replay(frame, turn);
        if (!row) {
            return tl::unexpected(row.error());
        }
        rows.push_back(std::move(*row));
    }
    return rows;
}

/// What is built when, and what it takes.
json buildsOf(const EditBench& bench) {
    const LiveSkip& live = bench.live();
    json builds = {{"always",
                    {{"structure", name(live.always().options.structure)},
                     {"blockEdge", live.always().options.blockEdgeVoxels},
                     {"ms", live.startMs()},
                     {"gpuBytes", gpuBytes(live.always())}}},
                   {"naiveMs", bench.naiveBuildMs()}};
    if (live.settled().exists()) {
        builds["settled"] = {{"structure", name(live.settled().options.structure)},
                             {"blockEdge", live.settled().options.blockEdgeVoxels},
                             {"lastMs", live.rebuildMs() > 0.0 ? json(live.rebuildMs()) : json()},
                             {"gpuBytes", gpuBytes(live.settled())}};
    }
    return builds;
}

json conditionsOf(const FramePlan& plan, const EditOptions& o, const EditScript& script) {
    const OrbitCamera& c = o.camera;
    return {{"size", {o.size.x, o.size.y}},
            {"camera", {c.azimuthDegrees, c.elevationDegrees, c.distanceRadii}},
            {"turnDegrees", o.turnDegrees},
            {"start", script.start.name},
            {"edits", !o.scriptFile.empty() ? "script"
                      : o.interpolate       ? "interpolation"
                                            : "usual"},
            {"classification", name(o.settings.classification)},
            {"planes", plan.planes},
            {"layersPerPlane", plan.layersPerPlane},
            {"workBudgetMs", o.workBudgetMs},
            {"quietFrames", o.quietFrames},
            {"octreeFrames", o.octreeFrames},
            {"replays", o.replays},
            {"verified", o.verify}};
}

constexpr CsvColumn kColumns[] = {{"frame", "/frame"},
                                  {"step", "/step"},
                                  {"edit", "/edit"},
                                  {"progress", "/progress"},
                                  {"structure", "/structure"},
                                  {"frame_ms", "/frameMs"},
                                  {"edit_ms", "/parts/editMs"},
                                  {"work_ms", "/parts/workMs"},
                                  {"prepare_ms", "/parts/prepareMs"},
                                  {"draw_ms", "/parts/drawMs"},
                                  {"octree_ms", "/octreeMs"},
                                  {"octree_worst_ms", "/octreeWorstMs"},
                                  {"over_octree", "/overOctree"},
                                  {"naive_ms", "/naiveMs"},
                                  {"equal", "/equal"},
                                  {"fragments", "/counters/fragments"},
                                  {"layers_evaluated", "/counters/layers_evaluated"},
                                  {"layers_skipped", "/counters/layers_skipped"},
                                  {"volume_fetches", "/counters/volume_fetches"},
                                  {"skip_fetches", "/counters/skip_fetches"},
                                  {"stretches", "/counters/stretches"},
                                  {"blocks_visited", "/counters/blocks_visited"}};

Result<void> write(const fs::path& folder, const json& report) {
    return writeFileAtomically(folder / "edit.csv", csvOf(report["rows"], kColumns))
        .and_then([&] { return writeFileAtomically(folder / "edit.json", report.dump(2) + "\n"); })
        .and_then([&] { return writePage(folder, "edit_report.py", "edit.json and edit.csv"); });
}

/// Fails: Internal, where a frame was drawn wrong.
Result<void> verdict(const std::vector<EditRow>& rows, const std::string& folder) {
    const std::int64_t wrong = std::count_if(
        rows.begin(), rows.end(), [](const EditRow& row) { return !row.equal.value_or(true); });
    return wrong == 0
               ? Result<void>{}
               : fail(ErrorCode::Internal,
                      fmt::format("{} of {} frames are not what drawing from scratch gives: see "
                                  "edit.csv in {}; report it",
                                  wrong, rows.size(), folder));
}

} // namespace

Result<void> editCommand(const EditOptions& options, const std::string& command) {
    LiveOptions live = liveOptions(options);
    live.quietFrames = options.quietFrames;
    SceneOptions scene = options;
    scene.settings.skip = SkipStructure::None; // the bench's scenes have what they need
    scene.settings.tighten = false;
    Result<OpenStage> opened = openStage(scene);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage* const stage = &opened->stage;
    const Result<EditScript> script = scriptOf(options, *stage);
    if (!script) {
        return tl::unexpected(script.error());
    }
    const Result<FramePlan> decided = decide(*stage, *script, live, options.settings);
    if (!decided) {
        return tl::unexpected(decided.error());
    }
    json report = reportHeader(runOf(command), *stage);
    report["conditions"] = conditionsOf(*decided, options, *script);
    std::vector<std::vector<EditRow>> replays;
    for (int replay = 0; replay < options.replays; ++replay) {
        Result<EditBench> bench = EditBench::open(*stage, options, live, script->start, *decided);
        if (!bench) {
            return tl::unexpected(bench.error());
        }
        Result<std::vector<EditRow>> rows = makeReportFolder(options.outputFolder).and_then([&] {
            return replayAll(*bench, *script, options, replay);
        });
        if (!rows) {
            return tl::unexpected(rows.error());
        }
        report["builds"] = buildsOf(*bench);
        replays.push_back(std::move(*rows));
    }
    const std::vector<EditRow> rows = mediansOf(replays);
    report["summary"] = summaryOf(rows, options);
    report["summary"]["compared_with"] = name(live.always.structure); // what "octree" stands for
    report["summary"]["worst_of_single_replays"] = worstOverOctree(replays);
    for (const EditRow& row : rows) {
        report["rows"].push_back(toJson(row, report["rows"].size()));
    }
    return write(options.outputFolder, report).and_then([&] {
        return verdict(rows, options.outputFolder);
    });
}

} // namespace slabcast

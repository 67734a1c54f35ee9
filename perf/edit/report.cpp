#include "perf/edit/report.h"

#include <algorithm>
#include <utility>

#include "perf/csv.h"
#include "perf/edit/summary.h"
#include "perf/json.h"
#include "perf/report_json.h"
#include "perf/settings_json.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

constexpr CsvColumn kColumns[] = {{"frame", "/frame"},
                                  {"step", "/step"},
                                  {"edit", "/edit"},
                                  {"progress", "/progress"},
                                  {"skip", "/skip"},
                                  {"frame_ms", "/frame_ms"},
                                  {"edit_ms", "/parts/edit_ms"},
                                  {"work_ms", "/parts/work_ms"},
                                  {"prepare_ms", "/parts/prepare_ms"},
                                  {"draw_ms", "/parts/draw_ms"},
                                  {"octree_ms", "/octree_ms"},
                                  {"octree_worst_ms", "/octree_worst_ms"},
                                  {"over_octree", "/over_octree"},
                                  {"budget_ms", "/budget_ms"},
                                  {"naive_ms", "/naive_ms"},
                                  {"equal", "/equal"},
                                  {"fragments", "/counters/fragments"},
                                  {"layers_evaluated", "/counters/layers_evaluated"},
                                  {"layers_skipped", "/counters/layers_skipped"},
                                  {"volume_fetches", "/counters/volume_fetches"},
                                  {"skip_fetches", "/counters/skip_fetches"},
                                  {"stretches", "/counters/stretches"},
                                  {"blocks_visited", "/counters/blocks_visited"}};

Json conditionsOf(const Stage& stage, const EditDesc& desc, const FramePlan& plan) {
    StageDesc picture = stage.desc();
    picture.settings = desc.settings; // the stage's are without skipping
    Json all = slabcast::conditionsOf(picture);
    all.update({{"turn_degrees", desc.turnDegrees},
                {"start", desc.script.start.name},
                {"edits", desc.origin},
                {"planes", plan.planes},
                {"layers_per_plane", plan.layersPerPlane},
                {"work_budget_ms", desc.workBudgetMs},
                {"quiet_frames", desc.live.quietFrames},
                {"octree_frames", desc.octreeFrames},
                {"replays", desc.replays},
                {"verified", desc.verify}});
    return all;
}

Json buildOf(const EditBuild& build) {
    return {{"structure", name(build.structure)},
            {"skip_block", build.blockEdge},
            {"gpu_bytes", build.gpuBytes}};
}

Json buildsOf(const EditBuilds& builds) {
    Json result = {{"always", buildOf(builds.always)}, {"naive_ms", builds.naiveMs}};
    result["always"]["ms"] = builds.always.ms;
    if (builds.settled) {
        result["settled"] = buildOf(*builds.settled);
        result["settled"]["last_ms"] = builds.settled->ms > 0.0 ? Json(builds.settled->ms) : Json();
    }
    return result;
}

Json rowOf(const EditRow& row, std::size_t index, std::optional<double> budgetMs) {
    Json result = {{"frame", index},
                   {"step", row.step},
                   {"edit", row.edited},
                   {"progress", name(row.progress)},
                   {"skip", row.structure},
                   {"frame_ms", row.frameMs},
                   {"parts",
                    {{"edit_ms", row.editMs},
                     {"work_ms", row.workMs},
                     {"prepare_ms", row.prepareMs},
                     {"draw_ms", row.drawMs}}},
                   {"octree_ms", row.octreeMs},
                   {"octree_worst_ms", row.octreeWorstMs},
                   {"over_octree", row.frameMs / row.octreeMs},
                   {"budget_ms", budgetOf(row, budgetMs)},
                   {"naive_ms", row.naiveMs},
                   {"counters", toJson(row.counters)}};
    if (row.equal) {
        result["equal"] = *row.equal;
    }
    return result;
}

Json summaryJson(const EditSummary& s, const EditDesc& desc, double worstOfReplays) {
    Json framesByStructure = Json::object();
    for (const auto& [structure, frames] : s.framesByStructure) {
        framesByStructure[structure] = frames;
    }
    Json summary = {{"compared_with", name(desc.live.always.structure)},
                    {"worst_over_octree_frame", s.overOctree.max},
                    {"over_octree_frame", toJson(s.overOctree)},
                    {"worst_added_over_octree_frame", s.worstAdded},
                    {"worst_octree_frame_over_median", s.worstOctreeSpread},
                    {"worst_of_single_replays", worstOfReplays},
                    {"frames", s.frames},
                    {"edits", s.edits},
                    {"budget_ms", desc.budgetMs ? Json(*desc.budgetMs) : Json()},
                    {"budget_over_octree", kBudgetOverOctree},
                    {"frames_over_budget", s.framesOverBudget},
                    {"frame_ms", toJson(s.frameMs)},
                    {"edit_frame_ms", toJson(s.editFrameMs)},
                    {"edit_ms", toJson(s.editMs)},
                    {"octree_frame_ms", toJson(s.octreeMs)},
                    {"naive",
                     {{"frame_ms", toJson(s.naiveMs)},
                      {"edit_frame_ms", toJson(s.naiveEditFrameMs)},
                      {"worst_over_octree_frame", s.worstNaive},
                      {"frames_over_budget", s.naiveFramesOverBudget}}},
                    {"frames_by_structure", std::move(framesByStructure)},
                    {"hand_overs", s.handOvers}};
    if (desc.verify) {
        summary["frames_equal"] = s.framesEqual;
        summary["frames_to_correct"] = s.framesToCorrect ? Json(*s.framesToCorrect) : Json();
    }
    return summary;
}

} // namespace

EditReport editReportOf(const Stage& stage, const EditDesc& desc, const EditMeasured& measured,
                        const RunInfo& run) {
    const std::vector<EditRow> rows = mediansOf(measured.replays);
    Json report = reportHeader(run, stage);
    report["conditions"] = conditionsOf(stage, desc, measured.decided);
    report["builds"] = buildsOf(measured.builds);
    report["summary"] =
        summaryJson(summaryOf(rows, desc.budgetMs), desc, worstOverOctree(measured.replays));
    for (const EditRow& row : rows) {
        report["rows"].push_back(rowOf(row, report["rows"].size(), desc.budgetMs));
    }
    const auto isWrong = [](const EditRow& row) { return !row.equal.value_or(true); };
    return {.json = report.dump(2) + "\n",
            .csv = csvOf(report["rows"], kColumns),
            .frames = static_cast<int>(rows.size()),
            .wrongFrames = static_cast<int>(std::count_if(rows.begin(), rows.end(), isWrong))};
}

} // namespace slabcast

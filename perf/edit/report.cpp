#include "perf/edit/report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "perf/csv.h"
#include "perf/edit/summary.h"
#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

using nlohmann::json;

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
                                  {"layers_evaluated", "/counters/layersEvaluated"},
                                  {"layers_skipped", "/counters/layersSkipped"},
                                  {"volume_fetches", "/counters/volumeFetches"},
                                  {"skip_fetches", "/counters/skipFetches"},
                                  {"stretches", "/counters/stretches"},
                                  {"blocks_visited", "/counters/blocksVisited"}};

json conditionsOf(const Stage& stage, const EditDesc& desc, const FramePlan& plan) {
    const StageDesc& picture = stage.desc();
    const OrbitCamera& c = picture.camera;
    return {{"size", {picture.size.x, picture.size.y}},
            {"camera", {c.azimuthDegrees, c.elevationDegrees, c.distanceRadii}},
            {"turnDegrees", desc.turnDegrees},
            {"start", desc.script.start.name},
            {"edits", desc.origin},
            {"classification", name(desc.settings.classification)},
            {"planes", plan.planes},
            {"layersPerPlane", plan.layersPerPlane},
            {"workBudgetMs", desc.workBudgetMs},
            {"quietFrames", desc.live.quietFrames},
            {"octreeFrames", desc.octreeFrames},
            {"replays", desc.replays},
            {"verified", desc.verify}};
}

json buildOf(const EditBuild& build) {
    return {{"structure", name(build.structure)},
            {"blockEdge", build.blockEdge},
            {"gpuBytes", build.gpuBytes}};
}

json buildsOf(const EditBuilds& builds) {
    json result = {{"always", buildOf(builds.always)}, {"naiveMs", builds.naiveMs}};
    result["always"]["ms"] = builds.always.ms;
    if (builds.settled) {
        result["settled"] = buildOf(*builds.settled);
        result["settled"]["lastMs"] = builds.settled->ms > 0.0 ? json(builds.settled->ms) : json();
    }
    return result;
}

json rowOf(const EditRow& row, std::size_t index) {
    json result = {{"frame", index},
                   {"step", row.step},
                   {"edit", row.edited},
                   {"progress", name(row.progress)},
                   {"structure", row.structure},
                   {"frameMs", row.frameMs},
                   {"parts",
                    {{"editMs", row.editMs},
                     {"workMs", row.workMs},
                     {"prepareMs", row.prepareMs},
                     {"drawMs", row.drawMs}}},
                   {"octreeMs", row.octreeMs},
                   {"octreeWorstMs", row.octreeWorstMs},
                   {"overOctree", row.frameMs / row.octreeMs},
                   {"naiveMs", row.naiveMs},
                   {"counters", toJson(row.counters)}};
    if (row.equal) {
        result["equal"] = *row.equal;
    }
    return result;
}

json summaryJson(const EditSummary& s, const EditDesc& desc, double worstOfReplays) {
    json summary = {{"comparedWith", name(desc.live.always.structure)},
                    {"worstOverOctreeFrame", s.overOctree.max},
                    {"overOctreeFrame", toJson(s.overOctree)},
                    {"worstAddedOverOctreeFrame", s.worstAdded},
                    {"worstOctreeFrameOverMedian", s.worstOctreeSpread},
                    {"worstOfSingleReplays", worstOfReplays},
                    {"framesOverOctreeBudget", s.framesOverOctreeBudget},
                    {"frames", s.frames},
                    {"edits", s.edits},
                    {"budgetMs", s.budgetMs},
                    {"budgetGiven", desc.budgetMs.has_value()},
                    {"framesOverBudget", s.framesOverBudget},
                    {"frameMs", toJson(s.frameMs)},
                    {"editFrameMs", toJson(s.editFrameMs)},
                    {"editMs", toJson(s.editMs)},
                    {"octreeFrameMs", toJson(s.octreeMs)},
                    {"naive",
                     {{"frameMs", toJson(s.naiveMs)},
                      {"editFrameMs", toJson(s.naiveEditFrameMs)},
                      {"worstOverOctreeFrame", s.worstNaive},
                      {"framesOverBudget", s.naiveFramesOverBudget}}},
                    {"framesByStructure", s.framesByStructure},
                    {"handOvers", s.handOvers}};
    if (desc.verify) {
        summary["framesEqual"] = s.framesEqual;
        summary["framesToCorrect"] = s.framesToCorrect ? json(*s.framesToCorrect) : json();
    }
    return summary;
}

} // namespace

EditReport editReportOf(const Stage& stage, const EditDesc& desc, const EditMeasured& measured,
                        const RunInfo& run) {
    const std::vector<EditRow> rows = mediansOf(measured.replays);
    json report = reportHeader(run, stage);
    report["conditions"] = conditionsOf(stage, desc, measured.decided);
    report["builds"] = buildsOf(measured.builds);
    report["summary"] =
        summaryJson(summaryOf(rows, desc.budgetMs), desc, worstOverOctree(measured.replays));
    for (const EditRow& row : rows) {
        report["rows"].push_back(rowOf(row, report["rows"].size()));
    }
    const auto isWrong = [](const EditRow& row) { return !row.equal.value_or(true); };
    return {.json = report.dump(2) + "\n",
            .csv = csvOf(report["rows"], kColumns),
            .frames = static_cast<int>(rows.size()),
            .wrongFrames = static_cast<int>(std::count_if(rows.begin(), rows.end(), isWrong))};
}

} // namespace slabcast

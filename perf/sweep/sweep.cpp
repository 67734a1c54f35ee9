#include "perf/sweep/sweep.h"

#include <algorithm>

#include "core/plan/settings_table.h"
#include "perf/csv.h"
#include "perf/json.h"
#include "perf/number.h"

namespace slabcast {

namespace {

/// What is measured at every ratio.
struct Series {
    SkipStructure skip;
    bool tighten;
};

std::vector<Series> seriesOf(const Settings& settings, SkipStructure built) {
    const bool skips = settings.skip != SkipStructure::None;
    std::vector<Series> series{{SkipStructure::None, false}};
    if (skips) {
        series.push_back({built, false});
    }
    if (settings.tighten) {
        series.push_back({skips ? built : SkipStructure::None, true});
    }
    return series;
}

/// The frames of one turn; the first, which warms up, gives the thumbnail.
struct Turn {
    FrameTimes times;
    double firstMs = 0.0;
};

Result<Turn> drawTurn(Stage& stage, const FramePlan& plan, int frames,
                      const std::string& thumbnailFile, ReportFolder& folder) {
    const Result<double> firstMs = stage.drawTimed(plan, 0.0);
    if (!firstMs) {
        return tl::unexpected(firstMs.error());
    }
    if (Result<void> saved =
            folder.savePicture(thumbnailFile, thumbnail(stage.desc().size, stage.picture(true)));
        !saved) {
        return tl::unexpected(saved.error());
    }
    std::vector<double> times;
    for (int k = 0; k < frames; ++k) {
        const Result<double> ms = stage.drawTimed(plan, 360.0 * k / frames);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        times.push_back(*ms);
    }
    return Turn{summarise(std::move(times)), *firstMs};
}

/// One row: plan, frames of one turn, work, thumbnail.
Result<Json> measureRow(Stage& stage, const Settings& settings, int frames,
                        const std::string& thumbnailFile, ReportFolder& folder) {
    const Result<FramePlan> plan = stage.plan(settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    if (Result<void> ready = stage.prepare(*plan); !ready) {
        return tl::unexpected(ready.error());
    }
    const Result<Turn> turn = drawTurn(stage, *plan, frames, thumbnailFile, folder);
    if (!turn) {
        return tl::unexpected(turn.error());
    }
    const bool terminates = plan->variant.terminates;
    // Drivers put off much of the compiling until a program is first drawn with.
    const double compileMs = stage.renderer().compileMs(plan->variant) +
                             std::max(0.0, turn->firstMs - turn->times.median);
    return Json{
        {"label", std::to_string(plan->planes) + "x" + std::to_string(plan->layersPerPlane)},
        {"classification", name(plan->variant.classification)},
        {"termination", terminates ? fixed(plan->terminationAlpha, 4) : "off"},
        {"lattice", name(plan->lattice.kind)},
        {"jitter", plan->lattice.jittered},
        {"planes", plan->planes},
        {"layers_per_plane", plan->layersPerPlane},
        {"form", plan->variant.unroll > 0 ? "unrolled" : "loop"},
        {"skip", name(plan->skip)},
        {"tighten", plan->tighten},
        {"frame_ms", toJson(turn->times)},
        {"counters", toJson(stage.countWork(*plan))},
        {"compile_ms", compileMs},
        {"variant", name(plan->variant)},
        {"thumbnail", thumbnailFile}};
}

Json conditions(const Stage& stage, int frames) {
    const StageDesc& o = stage.desc();
    const Settings& s = o.settings;
    const SceneFacts facts = stage.scene().facts();
    const int total = totalLayers(s, facts);
    return {{"size", Json::list({o.size.x, o.size.y})},
            {"camera", toJson(o.camera)},
            {"fov_degrees", o.fovDegrees},
            {"transfer_function", stage.scene().look().tf.name},
            {"classification", name(s.classification)},
            {"space", name(s.space)},
            {"target", name(s.target)},
            {"shade", get(s, "shade")},
            {"termination", s.termination ? fixed(*s.termination, 4) : "off"},
            {"lattice", name(s.lattice)},
            {"layer_spacing_mm", s.totalLayers ? 2.0 * facts.sphere.radiusMm / total
                                               : s.layerSpacingVoxels * facts.smallestVoxelEdgeMm},
            {"total_layers", total},
            {"tighten", s.tighten},
            {"frames_per_row", frames},
            {"views", o.stereoIpdMm ? 2 : 1}};
}

/// The part of the report that is the same for all rows; taken last, when memory has seen its peak.
Json header(const Stage& stage, int frames, const RunInfo& run) {
    const GpuMemory gpu = stage.renderer().gpuMemory();
    const BuiltSkip& skip = stage.scene().skip();
    Json result = reportHeader(run, stage);
    result["conditions"] = conditions(stage, frames);
    result["memory"] = {{"peak_host_bytes", run.peakHostBytes ? run.peakHostBytes() : 0},
                        {"volume_bytes", stage.info().bytes},
                        {"texture_bytes", gpu.volumeBytes},
                        {"skip_bytes", gpuBytes(skip)}};
    if (skip.exists()) {
        result["skip_build"] = {{"structure", name(skip.options.structure)},
                                {"block_edge", skip.options.blockEdgeVoxels},
                                {"builder", skip.onGpu ? "gpu" : "cpu"},
                                {"ms", skip.buildMs},
                                {"occupied_fraction", skip.occupiedFraction}};
    }
    return result;
}

constexpr CsvColumn kColumns[] = {{"planes", "/planes"},
                                  {"layers_per_plane", "/layers_per_plane"},
                                  {"form", "/form"},
                                  {"skip", "/skip"},
                                  {"tighten", "/tighten"},
                                  {"classification", "/classification"},
                                  {"termination", "/termination"},
                                  {"lattice", "/lattice"},
                                  {"jitter", "/jitter"},
                                  {"variant", "/variant"},
                                  {"compile_ms", "/compile_ms"}};

std::string twoDigits(std::size_t index) {
    return (index < 10 ? "0" : "") + std::to_string(index);
}

} // namespace

std::vector<Settings> sweepRows(const Settings& settings, const SceneFacts& facts,
                                std::vector<int> lengths) {
    const int total = totalLayers(settings, facts);
    if (lengths.empty()) {
        lengths.assign(kUnrollLengths.begin(), kUnrollLengths.end());
        lengths.push_back(0);
    }
    std::vector<Settings> rows;
    for (const Series& series : seriesOf(settings, facts.skip.structure)) {
        for (const int length : lengths) {
            Settings row = settings;
            row.layersPerPlane = length == 0 ? total : std::min(length, total);
            row.skip = series.skip;
            row.tighten = series.tighten;
            // A list of lengths reaches beyond what can be written out: those rows are loops.
            row.form = unrollLengthFor(*row.layersPerPlane) == 0 ? SegmentForm::Loop : row.form;
            rows.push_back(row);
        }
    }
    return rows;
}

Result<void> sweep(Stage& stage, const SweepDesc& desc, const RunInfo& run, ReportFolder& folder) {
    const std::vector<Settings> plans =
        sweepRows(stage.desc().settings, stage.scene().facts(), desc.layersPerPlane);
    Json rows = Json::list();
    ProgressLine progress(stage.watcher());
    for (const Settings& settings : plans) {
        progress.show(
            "row " + std::to_string(rows.size() + 1) + " of " + std::to_string(plans.size()) +
            ": " + std::to_string(*settings.layersPerPlane) + " layers per plane, skip " +
            name(*settings.skip) + ", " + (settings.tighten ? "tight planes" : "10-gons"));
        Result<Json> row = measureRow(
            stage, settings, desc.frames,
            std::string(kSweepThumbnails) + "/" + twoDigits(rows.size()) + ".png", folder);
        if (!row) {
            return tl::unexpected(row.error());
        }
        rows.push_back(std::move(*row));
    }
    Json report = header(stage, desc.frames, run);
    report["rows"] = std::move(rows);
    return folder.write("sweep.csv", csvOf(report["rows"], columnsOf({kColumns, kMeasuredColumns})))
        .and_then([&] { return folder.write("sweep.json", report.dump(2) + "\n"); });
}

} // namespace slabcast

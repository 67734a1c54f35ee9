#include <filesystem>

#include <fmt/core.h>

#include "perf/csv.h"
#include "perf/frame_times.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/commands.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What is measured at every ratio: the plain stack, then what skipping and tight planes add to it.
struct Series {
    SkipStructure skip;
    bool tighten;
};

std::vector<Series> seriesOf(const Stage& stage, const Settings& settings) {
    const bool skips = settings.skip != SkipStructure::None;
    const SkipStructure built = stage.scene().skip().options.structure;
    std::vector<Series> series{{SkipStructure::None, false}};
    if (skips) {
        series.push_back({built, false});
    }
    if (settings.tighten) {
        series.push_back({skips ? built : SkipStructure::None, true});
    }
    return series;
}

/// Layers per plane to measure: as asked for, or the unroll list; 0 stands for all of them, ray
/// casting.
std::vector<int> layerCounts(const SweepOptions& options, int total) {
    std::vector<int> counts = options.layersPerPlane;
    if (counts.empty()) {
        counts.assign(kUnrollLengths.begin(), kUnrollLengths.end());
        counts.push_back(0);
    }
    for (int& count : counts) {
        count = count == 0 ? total : std::min(count, total);
    }
    return counts;
}

/// The forms that a row is measured in: the settings' one, or on `auto` what the plan takes for the
/// length.
std::vector<Settings> rowSettings(const Stage& stage, const SweepOptions& options) {
    const int total = totalLayers(options.settings, stage.scene().facts());
    std::vector<Settings> rows;
    for (const Series& series : seriesOf(stage, options.settings)) {
        for (const int count : layerCounts(options, total)) {
            Settings row = options.settings;
            row.layersPerPlane = count;
            row.skip = series.skip;
            row.tighten = series.tighten;
            // A list of lengths reaches beyond what can be written out: those rows are loops.
            row.form = unrollLengthFor(count) == 0 ? SegmentForm::Loop : row.form;
            rows.push_back(row);
        }
    }
    return rows;
}

/// One row: plan, frames of one turn, work, thumbnail.
Result<json> measureRow(Stage& stage, const SweepOptions& options, const Settings& settings,
                        int index) {
    const Result<FramePlan> plan =
        slabcast::plan(stage.scene().facts(), settings, stage.caps(), {});
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    if (Result<void> ready = stage.prepare(*plan); !ready) {
        return tl::unexpected(ready.error());
    }
    std::vector<double> times;
    std::string thumbnailFile;
    double firstMs = 0.0;
    for (int k = -1; k < options.frames; ++k) { // -1 warms up and gives the thumbnail
        const Result<double> ms = stage.drawTimed(*plan, 360.0 * std::max(k, 0) / options.frames);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        if (k >= 0) {
            times.push_back(*ms);
            continue;
        }
        firstMs = *ms;
        const auto [size, pixels] = thumbnail(options.size, stage.picture(true));
        thumbnailFile = fmt::format("thumbnails/{:02}.png", index);
        if (Result<void> saved =
                savePicture(fs::path(options.outputFolder) / thumbnailFile, size, pixels, true);
            !saved) {
            return tl::unexpected(saved.error());
        }
    }
    const bool terminates = plan->variant.terminates;
    const FrameTimes summary = summarise(times);
    // Drivers put off much of the compiling until a program is first drawn with.
    const double compileMs =
        stage.renderer().compileMs(plan->variant) + std::max(0.0, firstMs - summary.median);
    return json{{"label", fmt::format("{}x{}", plan->planes, plan->layersPerPlane)},
                {"classification", name(plan->variant.classification)},
                {"termination", terminates ? fmt::format("{:.4f}", plan->terminationAlpha) : "off"},
                {"lattice", name(plan->lattice.kind)},
                {"jitter", plan->lattice.jittered},
                {"planes", plan->planes},
                {"layersPerPlane", plan->layersPerPlane},
                {"form", plan->variant.unroll > 0 ? "unrolled" : "loop"},
                {"skip", name(plan->skip)},
                {"tighten", plan->tighten},
                {"frameMs", toJson(summary)},
                {"counters", toJson(stage.countWork(*plan))},
                {"compileMs", compileMs},
                {"variant", name(plan->variant)},
                {"thumbnail", thumbnailFile}};
}

json conditions(const Stage& stage, const SweepOptions& o) {
    const Settings& s = o.settings;
    const SceneFacts facts = stage.scene().facts();
    const int total = totalLayers(s, facts);
    return {
        {"size", {o.size.x, o.size.y}},
        {"camera", {o.camera.azimuthDegrees, o.camera.elevationDegrees, o.camera.distanceRadii}},
        {"fovDegrees", o.fovDegrees},
        {"transferFunction", stage.scene().look().tf.name},
        {"classification", name(s.classification)},
        {"space", name(s.space)},
        {"target", name(s.target)},
        {"shade", s.shaded ? "phong" : "off"},
        {"termination", s.termination ? fmt::format("{:.4f}", *s.termination) : "off"},
        {"lattice", name(s.lattice)},
        {"layerSpacingMm", s.totalLayers ? 2.0 * facts.sphere.radiusMm / total
                                         : s.layerSpacingVoxels * facts.smallestVoxelEdgeMm},
        {"totalLayers", total},
        {"tighten", s.tighten},
        {"framesPerRow", o.frames},
        {"views", o.stereoIpdMm ? 2 : 1}};
}

/// The part of the report that is the same for all rows; taken last, when memory has seen its peak.
json header(Stage& stage, const SweepOptions& options, const std::string& command) {
    const GpuMemory gpu = stage.renderer().gpuMemory();
    const BuiltSkip& skip = stage.scene().skip();
    json result = reportHeader(runOf(command), stage);
    result["conditions"] = conditions(stage, options);
    result["memory"] = {{"peakHostBytes", peakHostBytes()},
                        {"volumeBytes", stage.info().bytes},
                        {"textureBytes", gpu.volumeBytes},
                        {"skipBytes", gpuBytes(skip)}};
    if (skip.exists()) {
        result["skipBuild"] = {{"structure", name(skip.options.structure)},
                               {"blockEdge", skip.options.blockEdgeVoxels},
                               {"builder", skip.onGpu ? "gpu" : "cpu"},
                               {"ms", skip.buildMs},
                               {"occupiedFraction", skip.occupiedFraction}};
    }
    return result;
}

constexpr CsvColumn kColumns[] = {{"planes", "/planes"},
                                  {"layersPerPlane", "/layersPerPlane"},
                                  {"form", "/form"},
                                  {"skip", "/skip"},
                                  {"tighten", "/tighten"},
                                  {"classification", "/classification"},
                                  {"termination", "/termination"},
                                  {"lattice", "/lattice"},
                                  {"jitter", "/jitter"},
                                  {"variant", "/variant"},
                                  {"compileMs", "/compileMs"}};

} // namespace

Result<void> sweepCommand(const SweepOptions& options, const std::string& command) {
    // Compile times are part of the report: a driver that finds its earlier results would report
    // none.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    Result<OpenStage> opened = openStage(options);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage* const stage = &opened->stage;
    const fs::path folder = options.outputFolder;
    if (Result<void> made = makeReportFolder(folder / "thumbnails"); !made) {
        return made;
    }
    const std::vector<Settings> plans = rowSettings(*stage, options);
    json rows = json::array();
    Progress progress;
    for (const Settings& settings : plans) {
        const int index = static_cast<int>(rows.size());
        progress.show(fmt::format("row {} of {}: {} layers per plane, skip {}, {}", index + 1,
                                  plans.size(), *settings.layersPerPlane, name(*settings.skip),
                                  settings.tighten ? "tight planes" : "10-gons"));
        Result<json> row = measureRow(*stage, options, settings, index);
        if (!row) {
            return tl::unexpected(row.error());
        }
        rows.push_back(std::move(*row));
    }
    json report = header(*stage, options, command);
    report["rows"] = std::move(rows);
    if (Result<void> done = writeFileAtomically(
            folder / "sweep.csv", csvOf(report["rows"], columnsOf({kColumns, kMeasuredColumns})));
        !done) {
        return done;
    }
    if (Result<void> done = writeFileAtomically(folder / "sweep.json", report.dump(2) + "\n");
        !done) {
        return done;
    }
    return writePage(folder, "report.py", "sweep.json and sweep.csv");
}

} // namespace slabcast

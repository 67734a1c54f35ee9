#include <filesystem>

#include <fmt/core.h>

#include "perf/csv.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "platform/cli/commands.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/report_files.h"
#include "platform/cli/skipbench_builds.h"
#include "platform/cli/skipbench_figures.h"
#include "platform/cli/skipbench_frames.h"
#include "platform/cli/skipbench_merging.h"
#include "platform/cli/skipbench_papers.h"
#include "platform/cli/skipbench_search.h"
#include "platform/cli/skipbench_sizes.h"
#include "platform/io/atomic_file.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr CsvColumn kColumns[] = {{"table", "/table"},
                                  {"volume", "/volume"},
                                  {"edge", "/edge"},
                                  {"family", "/family"},
                                  {"mode", "/mode"},
                                  {"finals_of", "/finalsOf"},
                                  {"structure", "/structure"},
                                  {"block_edge", "/blockEdge"},
                                  {"bits", "/bits"},
                                  {"partitions", "/partitions"},
                                  {"initial_level", "/initialLevel"},
                                  {"traversal", "/traversal"},
                                  {"tf", "/tf"},
                                  {"tf_name", "/tfName"},
                                  {"planes", "/planes"},
                                  {"layersPerPlane", "/layersPerPlane"},
                                  {"tighten", "/tighten"},
                                  {"order", "/order"},
                                  {"search_ms", "/ms"},
                                  {"speedup", "/speedup"},
                                  {"build_ms", "/buildMs/median"},
                                  {"build_ms_min", "/buildMs/min"},
                                  {"build_ms_max", "/buildMs/max"},
                                  {"gpu_build_ms", "/gpuBuildMs/median"},
                                  {"gpu_build_ms_min", "/gpuBuildMs/min"},
                                  {"gpu_build_ms_max", "/gpuBuildMs/max"},
                                  {"gpu_refused", "/gpuRefused"},
                                  {"build_of_ranges_ms", "/ofRangesMs/median"},
                                  {"init_ms", "/initMs"},
                                  {"update_ms", "/updateMs/median"},
                                  {"gpu_bytes", "/gpuBytes"},
                                  {"host_bytes", "/hostBytes"},
                                  {"occupied_fraction", "/occupiedFraction"},
                                  {"refused", "/refused"}};

/// The folder for the report, found to be writable before long work; gone again, if it was made
/// here, where that work fails.
class ReportFolder {
public:
    explicit ReportFolder(fs::path path) : path_(std::move(path)), made_(!fs::exists(path_)) {}
    ReportFolder(const ReportFolder&) = delete;
    ReportFolder& operator=(const ReportFolder&) = delete;
    ~ReportFolder() {
        std::error_code ignored;
        if (made_) {
            fs::remove(path_, ignored); // only where it is empty
        }
    }

    Result<void> make() const {
        return makeReportFolder(path_).and_then(
            [this] { return checkWritable(path_ / "skipbench.json"); });
    }
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
    bool made_;
};

/// Of one volume: what a stage is opened with.
SceneOptions sceneOf(const SkipbenchOptions& options, const std::string& volume) {
    SceneOptions scene = options;
    scene.input.volume = volume;
    scene.settings.shaded = true;                // for the rows that are; the others leave it out
    scene.settings.skip = SkipStructure::Blocks; // codes are made here, for all that follow
    const std::vector<std::string> presets = presetNames();
    for (const std::string& preset : presets) { // a phantom may have a preset of its own
        const bool own =
            volume == "phantom:" + preset || volume.starts_with("phantom:" + preset + ":");
        if (options.tf.empty() && own) {
            scene.tf = preset;
        }
    }
    return scene;
}

const char* name(Modality modality) {
    return modality == Modality::Ct ? "ct" : modality == Modality::Mr ? "mr" : "unknown";
}

json describe(const Stage& stage, const std::string& input, const std::string& label,
              const Workshop& workshop) {
    json volume = toJson(stage.info());
    volume.update({{"name", label},
                   {"input", input},
                   {"modality", name(stage.info().modality)},
                   {"transferFunction", stage.scene().look().tf.name},
                   {"texelFormat", name(stage.scene().texels().format)},
                   {"texelBytes", stage.scene().texels().data.size()},
                   {"codesMs", workshop.codesMs()}});
    return volume;
}

/// All tables of one volume but its sizes.
Result<void> measureVolume(SkipBench& bench, const std::string& input, json& volumes) {
    if (!bench.stage.scene().facts().anythingVisible) {
        return fail(
            ErrorCode::InvalidArgument,
            fmt::format("{}: '{}' shows nothing of it, so there is nothing to compare: give "
                        "another --tf",
                        input, bench.stage.scene().look().tf.name));
    }
    const Workshop workshop(bench.stage);
    volumes.push_back(describe(bench.stage, input, bench.volume, workshop));
    const Result<BestParameters> best = searchParameters(bench);
    if (!best) {
        return tl::unexpected(best.error());
    }
    bench.progress.show(bench.volume + ": building");
    const Result<json> builds = buildRows(workshop, workshop.visibilityUnder(bench.stage.scene()),
                                          best->marching, kFewestFrames, bench.row("structures"));
    if (!builds) {
        return tl::unexpected(builds.error());
    }
    bench.rows.insert(bench.rows.end(), builds->begin(), builds->end());
    std::vector<Refusal> refused; // rows of the table before name them
    Result<std::vector<Subject>> marching = subjectsOf(bench.stage, best->marching, refused);
    if (!marching) {
        return tl::unexpected(marching.error());
    }
    Result<std::vector<Subject>> terminating = subjectsOf(bench.stage, best->terminating, refused);
    if (!terminating) {
        return tl::unexpected(terminating.error());
    }
    return measureFrames(bench, {std::move(*marching), std::move(*terminating)}).and_then([&] {
        return measureMerging(bench, workshop);
    });
}

/// Labels that tell volumes apart.
std::string labelOf(const std::string& name, const json& volumes) {
    std::string label = name;
    const auto taken = [&] {
        return std::any_of(volumes.begin(), volumes.end(),
                           [&](const json& volume) { return volume["name"] == label; });
    };
    for (int k = 2; taken(); ++k) {
        label = fmt::format("{} ({})", name, k);
    }
    return label;
}

json conditions(const SkipbenchOptions& o) {
    const Settings& s = o.settings;
    return {
        {"size", {o.size.x, o.size.y}},
        {"camera", {o.camera.azimuthDegrees, o.camera.elevationDegrees, o.camera.distanceRadii}},
        {"fovDegrees", o.fovDegrees},
        {"layerSpacingVoxels", s.layerSpacingVoxels},
        {"lattice", name(s.lattice)},
        {"target", name(s.target)},
        {"space", name(s.space)},
        {"classification", name(s.classification)},
        {"termination", s.termination ? json(*s.termination) : json("off")},
        {"framesPerRowAtMost", o.frames},
        {"partitionBudgetBytes", o.skip.memoryBudgetBytes},
        {"sizes", o.sizes},
        {"quick", o.quick}};
}

/// That all volumes can be read, before minutes are spent on the first.
Result<void> checkVolumes(const SkipbenchOptions& options) {
    for (const std::string& input : options.volumes) {
        const Result<Volume> volume = openVolume({.volume = input});
        if (!volume) {
            return tl::unexpected(volume.error());
        }
    }
    return {};
}

Result<json> measured(const SkipbenchOptions& options, const std::string& command) {
    json report, rows = json::array(), volumes = json::array();
    Progress progress;
    for (const std::string& input : options.volumes) {
        const SceneOptions scene = sceneOf(options, input);
        {
            Result<OpenStage> opened = openStage(scene);
            if (!opened) {
                return tl::unexpected(opened.error());
            }
            Stage* const stage = &opened->stage;
            SkipBench bench{*stage, options, labelOf(stage->info().name, volumes), progress};
            if (Result<void> done = measureVolume(bench, input, volumes); !done) {
                return tl::unexpected(done.error());
            }
            rows.insert(rows.end(), bench.rows.begin(), bench.rows.end());
            report = reportHeader(runOf(command), *stage);
        }
        if (volumes.size() == 1) {
            const Result<json> sizes =
                measureSizes(options, scene, volumes[0]["name"].get<std::string>(), progress);
            if (!sizes) {
                return sizes;
            }
            rows.insert(rows.end(), sizes->begin(), sizes->end());
        }
    }
    report.erase("volume"); // there may be several
    report["conditions"] = conditions(options);
    report["figures"] = figuresOf(volumes, rows);
    report["papers"] = publishedTables();
    report["volumes"] = std::move(volumes);
    report["rows"] = std::move(rows);
    return report;
}

} // namespace

Result<void> skipbenchCommand(const SkipbenchOptions& options, const std::string& command) {
    const ReportFolder folder(options.outputFolder);
    if (Result<void> ready = checkVolumes(options).and_then([&] { return folder.make(); });
        !ready) {
        return ready;
    }
    Result<json> report = measured(options, command);
    if (!report) {
        return tl::unexpected(report.error());
    }
    (*report)["summary"] = summaryOf((*report)["figures"]);
    const std::vector<CsvColumn> columns = columnsOf({kColumns, kMeasuredColumns});
    return writeFileAtomically(folder.path() / "skipbench.csv", csvOf((*report)["rows"], columns))
        .and_then([&] {
            return writeFileAtomically(folder.path() / "skipbench.json", report->dump(2) + "\n");
        })
        .and_then([&] {
            return writePage(folder.path(), "skipbench_report.py",
                             "skipbench.json and skipbench.csv");
        })
        .map([&] { fmt::print("{}\n", lineOf((*report)["summary"], (*report)["figures"])); });
}

} // namespace slabcast

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/cli/commands.h"
#include "platform/cli/draw.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/progress.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kThumbnailEdge = 192;

/// What is measured at every ratio: the plain stack, then what skipping and tight planes add to it.
struct Series {
    SkipStructure skip;
    bool tighten;
};

std::vector<Series> seriesOf(const Settings& settings) {
    std::vector<Series> series{{SkipStructure::None, false}};
    if (settings.skip != SkipStructure::None) {
        series.push_back({SkipStructure::Proximity, false});
    }
    if (settings.tighten) {
        series.push_back(
            {settings.skip == SkipStructure::None ? SkipStructure::None : SkipStructure::Proximity,
             true});
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
std::vector<Settings> rowSettings(const SweepOptions& options, int total) {
    std::vector<Settings> rows;
    for (const Series& series : seriesOf(options.settings)) {
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

/// Box-filtered to a small edge.
std::pair<glm::ivec2, std::vector<glm::vec4>> thumbnail(glm::ivec2 size,
                                                        const std::vector<glm::vec4>& picture) {
    const int shrink = std::max(1, std::max(size.x, size.y) / kThumbnailEdge);
    const glm::ivec2 small = glm::max(size / shrink, glm::ivec2(1));
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(small.x) * small.y, glm::vec4(0.0F));
    for (int y = 0; y < small.y * shrink && y < size.y; ++y) {
        for (int x = 0; x < small.x * shrink && x < size.x; ++x) {
            pixels[static_cast<std::size_t>(y / shrink) * small.x + x / shrink] +=
                picture[static_cast<std::size_t>(y) * size.x + x] /
                static_cast<float>(shrink * shrink);
        }
    }
    return {small, std::move(pixels)};
}

std::string timestamp() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

/// One row: plan, frames of one turn, work, thumbnail.
Result<json> measureRow(Stage& stage, const SweepOptions& options, const Settings& settings,
                        int index) {
    const Result<FramePlan> plan =
        slabcast::plan(stage.scene().facts(), settings, stage.session().caps, {});
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
                {"planes", plan->planes},
                {"layersPerPlane", plan->layersPerPlane},
                {"form", plan->variant.unroll > 0 ? "unrolled" : "loop"},
                {"skip", name(plan->variant.skip)},
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
    const ProximityCloud* cloud = stage.scene().cloud();
    json result = {{"command", command},
                   {"commit", commit()},
                   {"date", timestamp()},
                   {"device", toJson(stage.session().caps)},
                   {"volume", toJson(stage.info())},
                   {"conditions", conditions(stage, options)},
                   {"memory",
                    {{"peakHostBytes", peakHostBytes()},
                     {"volumeBytes", stage.info().bytes},
                     {"textureBytes", gpu.volumeBytes},
                     {"skipBytes", cloud != nullptr ? cloud->freeLengths.size() : 0}}}};
    if (cloud != nullptr) {
        result["skipBuild"] = {{"structure", "proximity"},
                               {"blockEdge", cloud->blockEdgeVoxels},
                               {"ms", stage.scene().cloudBuildMs()},
                               {"occupiedFraction", stage.scene().facts().occupiedFraction}};
    }
    return result;
}

std::string csvOf(const json& rows) {
    static const char* const kColumns[] = {"planes",  "layersPerPlane", "form",        "skip",
                                           "tighten", "classification", "termination", "lattice",
                                           "variant", "compileMs"};
    static const char* const kTimes[] = {"median", "min", "max", "p10", "p90", "n"};
    static const char* const kCounters[] = {"fragments", "layers_evaluated", "layers_skipped",
                                            "volume_fetches", "skip_fetches"};
    const auto cell = [](const json& value) {
        return value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump();
    };
    std::string text;
    const auto addLine = [&text](auto&& valueOf) {
        std::string line;
        for (const char* column : kColumns)
            line += valueOf(nullptr, column) + ",";
        for (const char* column : kTimes)
            line += valueOf("frameMs", column) + ",";
        for (const char* column : kCounters)
            line += valueOf("counters", column) + ",";
        line.back() = '\n';
        text += line;
    };
    addLine([](const char* group, const char* column) {
        return group != nullptr && std::string_view(group) == "frameMs"
                   ? std::string("frame_ms_") + column
                   : std::string(column);
    });
    for (const json& row : rows) {
        addLine([&](const char* group, const char* column) {
            const json& part = group == nullptr ? row : row.at(group);
            return part.is_null() ? std::string() : cell(part.at(column));
        });
    }
    return text;
}

/// Runs a program of these words and waits for it; what it prints goes to stderr. True where it
/// ends well.
bool run(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    pid_t child = 0;
    const bool started =
        posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    return started && waitpid(child, &status, 0) == child && status == 0;
}

/// The page is made by a script from the JSON, so that it can be made again.
Result<void> writePage(const std::string& folder) {
    const fs::path installed =
        fs::read_symlink("/proc/self/exe").parent_path() / "../share/slabcast/perf/report.py";
    const fs::path script = fs::exists(installed) ? installed : fs::path(SLABCAST_REPORT_SCRIPT);
    if (!run({"/usr/bin/python3", script.string(), folder})) {
        return fail(
            ErrorCode::FileUnwritable,
            fmt::format("{0}/sweep.json and sweep.csv are written, report.html is not: install "
                        "python3-matplotlib, then run {1} {0}",
                        folder, script.string()));
    }
    return {};
}

} // namespace

Result<void> sweepCommand(const SweepOptions& options, const std::string& command) {
    // Compile times are part of the report: a driver that finds its earlier results would report
    // none.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    Result<Stage> stage = Stage::open(options);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    std::error_code error;
    const fs::path folder = options.outputFolder;
    fs::create_directories(folder / "thumbnails", error);
    if (error) {
        return fail(ErrorCode::FileUnwritable,
                    fmt::format("{}: cannot make this folder ({}): give another to --out",
                                options.outputFolder, error.message()));
    }
    const std::vector<Settings> plans =
        rowSettings(options, totalLayers(options.settings, stage->scene().facts()));
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
    if (Result<void> done = writeFileAtomically(folder / "sweep.csv", csvOf(report["rows"]));
        !done) {
        return done;
    }
    if (Result<void> done = writeFileAtomically(folder / "sweep.json", report.dump(2) + "\n");
        !done) {
        return done;
    }
    return writePage(options.outputFolder);
}

} // namespace slabcast

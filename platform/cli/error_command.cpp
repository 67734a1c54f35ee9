#include <chrono>
#include <optional>
#include <tuple>

#include <fmt/core.h>

#include "perf/csv.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "platform/cli/commands.h"
#include "platform/cli/commit.h"
#include "platform/cli/error_grid.h"
#include "platform/cli/error_rows.h"
#include "platform/cli/error_table_file.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/reference_pictures.h"
#include "platform/cli/report_files.h"
#include "platform/cli/scene_key.h"
#include "platform/cli/scene_options.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kReferencePicture = "pictures/reference.png";

constexpr CsvColumn kColumns[] = {{"id", "/id"},
                                  {"spacing", "/spacing"},
                                  {"layers", "/layers"},
                                  {"ratio", "/ratio"},
                                  {"classification", "/classification"},
                                  {"target", "/target"},
                                  {"termination", "/termination"},
                                  {"jitter", "/jitter"},
                                  {"planes", "/plan/planes"},
                                  {"layersPerPlane", "/plan/layersPerPlane"},
                                  {"totalLayers", "/plan/layers"},
                                  {"variant", "/plan/variant"},
                                  {"rmse", "/error/total/rmse"},
                                  {"psnr", "/error/total/psnr"},
                                  {"max", "/error/total/max"},
                                  {"meanDeltaE", "/error/total/meanDeltaE"},
                                  {"p999DeltaE", "/error/total/p999DeltaE"},
                                  {"sampling_rmse", "/error/sampling/rmse"},
                                  {"table_rmse", "/error/table/rmse"},
                                  {"gpu_rmse", "/error/gpu/rmse"},
                                  {"order_total", "/order/total"},
                                  {"order_sampling", "/order/sampling"},
                                  {"order_table", "/order/table"},
                                  {"order_gpu", "/order/gpu"}};
constexpr CsvColumn kLastColumns[] = {{"date", "/date"}, {"command", "/command"}};

json cameraJson(const OrbitCamera& c) {
    return {c.azimuthDegrees, c.elevationDegrees, c.distanceRadii};
}

/// All that the continuous picture depends on.
json referenceKey(const Stage& stage, const ErrorOptions& o) {
    const Scene& scene = stage.scene();
    return {{"commit", commit()},
            {"voxels", fingerprint(stage.values().data)},
            {"placement", placementKey(scene.geometry())},
            {"transfer function", transferKey(scene.look().tf)},
            {"space", name(scene.look().space)},
            {"camera", cameraJson(o.camera)},
            {"field of view", o.fovDegrees},
            {"size", {o.size.x, o.size.y}},
            {"tolerance", kReferenceTolerance}};
}

/// And what a row depends on beyond its own settings.
json rowsKey(const Stage& stage, const ErrorOptions& o) {
    const Settings& s = o.settings;
    json key = referenceKey(stage, o);
    key.update({{"device", toJson(stage.caps())},
                {"texels", name(stage.scene().texels().format)},
                {"lattice", name(s.lattice)},
                {"form", wordFor(formWords(), s.form)},
                {"skip", s.skip ? name(*s.skip) : "auto"},
                {"skip block", o.skip.blockEdgeVoxels},
                {"tighten", s.tighten},
                {"quick", o.quick},
                {"frames", o.frames}});
    return key;
}

json conditions(const Stage& stage, const ErrorOptions& o) {
    const Settings& s = o.settings;
    return {{"size", {o.size.x, o.size.y}},
            {"camera", cameraJson(o.camera)},
            {"fovDegrees", o.fovDegrees},
            {"transferFunction", stage.scene().look().tf.name},
            {"space", name(s.space)},
            {"lattice", name(s.lattice)},
            {"form", wordFor(formWords(), s.form)},
            {"skip", s.skip ? name(*s.skip) : "auto"},
            {"tighten", s.tighten},
            {"texelFormat", name(stage.scene().texels().format)},
            {"quantisationError", stage.scene().texels().maxQuantisationError},
            {"smallestVoxelEdgeMm", stage.scene().facts().smallestVoxelEdgeMm},
            {"framesPerRowAtMost", o.frames},
            {"quick", o.quick}};
}

/// From the store, or integrated and put there; its picture too.
Result<void> makeReference(const Stage& stage, const ErrorOptions& o, ErrorStore& store) {
    if (!store.reference()) {
        Progress progress;
        const auto start = std::chrono::steady_clock::now();
        StoredReference made;
        made.pixels = continuousPicture(stage, o.size, [&progress](double done) {
            progress.show(fmt::format("integrating the exact picture: {:.0f} %", 100.0 * done));
        });
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        made.seconds = took.count();
        if (Result<void> kept = store.setReference(std::move(made)); !kept) {
            return kept;
        }
    }
    return savePicture(fs::path(o.outputFolder) / kReferencePicture, o.size,
                       shown(store.reference()->pixels, o.size, stage.scene().look().space), true);
}

json frontByTime(const json& rows) {
    return frontOf(rows, [](const json& row) {
        return std::optional(row.at("frameMs").at("median").get<double>());
    });
}

json frontByFetches(const json& rows) {
    return frontOf(rows, [](const json& row) {
        const json& counters = row.at("counters");
        return counters.is_null() ? std::nullopt
                                  : std::optional(counters.at("volume_fetches").get<double>() +
                                                  counters.at("skip_fetches").get<double>());
    });
}

/// Whether all that a row does not name is as `render` has it unless told otherwise.
bool isUsual(const ErrorOptions& o) {
    const auto othersOf = [](const SceneOptions& scene) {
        const Settings& s = scene.settings;
        return std::make_tuple(s.skip, s.tighten, s.lattice, s.form, scene.skip, scene.input.exact);
    };
    return othersOf(o) == othersOf(SceneOptions{});
}

/// Into the table that `render --target-error` reads. The report is there already: what goes wrong
/// is only said.
void refreshTable(const Stage& stage, const ErrorOptions& o, const std::vector<Sampling>& grid,
                  const json& rows) {
    if (!isUsual(o)) {
        fmt::print(stderr,
                   "slabcast: the table for --target-error is left as it was: it holds what "
                   "was measured without --skip, its parameters, --tighten, --lattice, "
                   "--form and --exact\n");
        return;
    }
    std::vector<MeasuredError> fresh;
    for (const Sampling& sampling : grid) {
        for (const json& row : rows) {
            if (row.at("id") == idOf(sampling)) {
                const double megapixels = 1e-6 * o.size.x * o.size.y;
                fresh.push_back({labelOf(stage), o.size, sampling, totalRmse(row),
                                 row.at("frameMs").at("median").get<double>() / megapixels,
                                 commit()});
            }
        }
    }
    const Result<void> done = errorTablePath(stage.caps()).and_then([&fresh](const fs::path& path) {
        return readErrorTable(path).and_then([&](std::vector<MeasuredError> table) {
            return writeErrorTable(path, refreshed(std::move(table), fresh));
        });
    });
    if (!done) {
        fmt::print(stderr, "slabcast: {}\n", done.error().detail);
    }
}

} // namespace

Result<void> errorCommand(const ErrorOptions& given, const std::string& command) {
    const std::string started = timestamp();
    ErrorOptions options = given;
    options.background.reset();
    options.input.keepValues = true;
    options.axes = completed(options.axes, options.quick);
    Result<OpenStage> opened = openStage(options);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage* const stage = &opened->stage;
    const fs::path folder = options.outputFolder;
    if (Result<void> made = makeReportFolder(folder / "pictures"); !made) {
        return made;
    }
    std::vector<std::string> notes;
    ErrorStore store =
        ErrorStore::open(folder, referenceKey(*stage, options), rowsKey(*stage, options), notes);
    for (const std::string& note : notes) {
        fmt::print(stderr, "slabcast: {}\n", note);
    }
    if (Result<void> made = makeReference(*stage, options, store); !made) {
        return made;
    }
    const std::vector<Sampling> grid = gridOf(options.axes, options.quick);
    ErrorRows measured(*stage, options, store);
    Result<json> rows = measured.measure(grid);
    if (!rows) {
        return tl::unexpected(rows.error());
    }
    addOrders(*rows);
    const std::vector<CsvColumn> columns = columnsOf({kColumns, kMeasuredColumns, kLastColumns});
    if (Result<void> done = writeFileAtomically(folder / "error.csv", csvOf(*rows, columns));
        !done) {
        return done;
    }
    json report = reportHeader(runOf(command), *stage);
    report.update({{"started", started},
                   {"leftOut", measured.leftOut()},
                   {"conditions", conditions(*stage, options)},
                   {"axes", toJson(options.axes)},
                   {"reference",
                    {{"seconds", store.reference()->seconds},
                     {"tolerance", kReferenceTolerance},
                     {"size", {options.size.x, options.size.y}},
                     {"picture", kReferencePicture}}},
                   {"front", frontByTime(*rows)},
                   {"frontByFetches", frontByFetches(*rows)}});
    report["rows"] = std::move(*rows);
    if (Result<void> done = writeFileAtomically(folder / "error.json", report.dump(2) + "\n");
        !done) {
        return done;
    }
    const Result<void> page = writePage(folder, "error_report.py", "error.json and error.csv");
    refreshTable(*stage, options, grid, report["rows"]);
    return page;
}

} // namespace slabcast

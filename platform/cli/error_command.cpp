#include <chrono>
#include <optional>

#include <fmt/core.h>

#include "platform/cli/commands.h"
#include "platform/cli/error_grid.h"
#include "platform/cli/error_rows.h"
#include "platform/cli/error_table_file.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/reference_pictures.h"
#include "platform/cli/report_files.h"
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
                                  {"order_gpu", "/order/gpu"},
                                  {"frame_ms_median", "/frameMs/median"},
                                  {"frame_ms_min", "/frameMs/min"},
                                  {"frame_ms_max", "/frameMs/max"},
                                  {"frame_ms_p10", "/frameMs/p10"},
                                  {"frame_ms_p90", "/frameMs/p90"},
                                  {"frame_ms_n", "/frameMs/n"},
                                  {"fragments", "/counters/fragments"},
                                  {"layers_evaluated", "/counters/layers_evaluated"},
                                  {"layers_skipped", "/counters/layers_skipped"},
                                  {"volume_fetches", "/counters/volume_fetches"},
                                  {"skip_fetches", "/counters/skip_fetches"},
                                  {"command", "/command"}};

/// FNV-1a: equal volumes are told from others, no more is needed.
std::string fingerprint(const std::vector<std::byte>& bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const std::byte byte : bytes) {
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * 1099511628211ULL;
    }
    return fmt::format("{:016x}", hash);
}

json transferKey(const TransferFunction& tf) {
    json points = json::array();
    for (const TransferPoint& p : tf.points) {
        points.push_back({p.value, p.color.x, p.color.y, p.color.z, p.opacity});
    }
    return {{"opacityUnitMm", tf.opacityUnitMm}, {"points", std::move(points)}};
}

json cameraJson(const OrbitCamera& c) {
    return {c.azimuthDegrees, c.elevationDegrees, c.distanceRadii};
}

/// All that the continuous picture depends on.
json referenceKey(const Stage& stage, const ErrorOptions& o) {
    const Scene& scene = stage.scene();
    json placement = json::array();
    const glm::dmat4 modelFromUvw = scene.geometry().modelFromUvw();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            placement.push_back(modelFromUvw[column][row]);
        }
    }
    const glm::ivec3 dims = scene.geometry().dims;
    return {{"commit", commit()},
            {"voxels", fingerprint(stage.values().data)},
            {"dims", {dims.x, dims.y, dims.z}},
            {"placement", std::move(placement)},
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
    key.update({{"device", toJson(stage.session().caps)},
                {"texels", name(stage.scene().texels().format)},
                {"lattice", name(s.lattice)},
                {"form", wordFor(formWords(), s.form)},
                {"skip", s.skip ? name(*s.skip) : "auto"},
                {"skip block", o.skipBlockEdge},
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
            {"framesPerRow", o.frames},
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

/// Into the table that `render --target-error` reads. The report is there already: what goes wrong
/// is only said.
void refreshTable(const Stage& stage, const ErrorOptions& o, const std::vector<Sampling>& grid,
                  const json& rows) {
    std::vector<MeasuredError> fresh;
    for (const Sampling& sampling : grid) {
        for (const json& row : rows) {
            if (row.at("id") == idOf(sampling)) {
                const double megapixels = 1e-6 * o.size.x * o.size.y;
                fresh.push_back({labelOf(stage), o.size, sampling, totalRmse(row),
                                 row.at("frameMs").at("median").get<double>() / megapixels});
            }
        }
    }
    const Result<fs::path> path = errorTablePath(stage.session().caps);
    if (!path) {
        fmt::print(stderr, "slabcast: {}\n", path.error().detail);
        return;
    }
    Result<std::vector<MeasuredError>> table = readErrorTable(*path);
    if (!table) {
        fmt::print(stderr, "slabcast: {}: held no table of measured errors: written anew\n",
                   path->string());
        table = std::vector<MeasuredError>{};
    }
    if (Result<void> written = writeErrorTable(*path, refreshed(std::move(*table), fresh));
        !written) {
        fmt::print(stderr, "slabcast: {}\n", written.error().detail);
    }
}

} // namespace

Result<void> errorCommand(const ErrorOptions& given, const std::string& command) {
    if (given.settings.shaded) {
        return fail(ErrorCode::InvalidArgument,
                    "errors are measured without shading, as the exact picture has none: leave "
                    "--shade phong out");
    }
    ErrorOptions options = given;
    options.background.reset();
    options.input.keepValues = true;
    options.axes = completed(options.axes, options.quick);
    options.settings.classification = options.axes.classifications.front();
    Result<Stage> stage = Stage::open(options);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
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
    Result<json> rows = ErrorRows(*stage, options, store).measure(grid);
    if (!rows) {
        return tl::unexpected(rows.error());
    }
    addOrders(*rows);
    if (Result<void> done = writeFileAtomically(folder / "error.csv", csvOf(*rows, kColumns));
        !done) {
        return done;
    }
    refreshTable(*stage, options, grid, *rows);
    json report = reportHeader(*stage, command);
    report.update({{"conditions", conditions(*stage, options)},
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
    return writePage(folder, "error_report.py", "error.json and error.csv");
}

} // namespace slabcast

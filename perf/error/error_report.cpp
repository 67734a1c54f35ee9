#include "perf/error/error_report.h"

#include <optional>
#include <utility>

#include "core/base/stopwatch.h"
#include "perf/csv.h"
#include "perf/error/error_rows.h"
#include "perf/error/error_store.h"
#include "perf/error/error_table_json.h"
#include "perf/error/reference_pictures.h"
#include "perf/error/scene_key.h"
#include "perf/error/verification.h"
#include "perf/json.h"
#include "perf/settings_json.h"

namespace slabcast {

namespace {

const std::string kReferencePicture = std::string(kErrorPictures) + "/reference.png";

constexpr CsvColumn kColumns[] = {{"id", "/id"},
                                  {"layer_spacing", "/layer_spacing"},
                                  {"layers_per_plane", "/layers_per_plane"},
                                  {"ratio", "/ratio"},
                                  {"classify", "/classify"},
                                  {"target", "/target"},
                                  {"termination", "/termination"},
                                  {"jitter", "/jitter"},
                                  {"planes", "/plan/planes"},
                                  {"drawn_layers_per_plane", "/plan/layers_per_plane"},
                                  {"total_layers", "/plan/layers"},
                                  {"variant", "/plan/variant"},
                                  {"rmse", "/error/total/rmse"},
                                  {"psnr", "/error/total/psnr"},
                                  {"max", "/error/total/max"},
                                  {"mean_delta_e", "/error/total/mean_delta_e"},
                                  {"p999_delta_e", "/error/total/p999_delta_e"},
                                  {"sampling_rmse", "/error/sampling/rmse"},
                                  {"table_rmse", "/error/table/rmse"},
                                  {"gpu_rmse", "/error/gpu/rmse"},
                                  {"order_total", "/order/total"},
                                  {"order_sampling", "/order/sampling"},
                                  {"order_table", "/order/table"},
                                  {"order_gpu", "/order/gpu"}};
constexpr CsvColumn kMomentColumns[] = {{"bias", "/error/total/bias"},
                                        {"deviation", "/error/total/deviation"},
                                        {"red_bias", "/error/total/red_bias"},
                                        {"red_deviation", "/error/total/red_deviation"},
                                        {"green_bias", "/error/total/green_bias"},
                                        {"green_deviation", "/error/total/green_deviation"},
                                        {"blue_bias", "/error/total/blue_bias"},
                                        {"blue_deviation", "/error/total/blue_deviation"},
                                        {"visible_share", "/error/total/visible_share"},
                                        {"alpha_rmse", "/error/total/alpha_rmse"},
                                        {"alpha_max", "/error/total/alpha_max"},
                                        {"alpha_bias", "/error/total/alpha_bias"},
                                        {"alpha_deviation", "/error/total/alpha_deviation"},
                                        {"alpha_visible_share", "/error/total/alpha_visible_share"},
                                        {"flip_mean", "/flip/mean"},
                                        {"flip_max", "/flip/max"}};
constexpr CsvColumn kLastColumns[] = {{"date", "/date"}, {"command", "/command"}};

/// All that the continuous picture depends on.
Json referenceKey(const Stage& stage, const RunInfo& run) {
    const Scene& scene = stage.scene();
    const StageDesc& o = stage.desc();
    return {{"commit", run.commit},
            {"voxels", fingerprint(stage.values().data)},
            {"placement", placementKey(scene.geometry())},
            {"transfer_function", transferKey(scene.look().tf)},
            {"space", name(scene.provided()->space)},
            {"camera", toJson(o.camera)},
            {"fov_degrees", o.fovDegrees},
            {"size", Json::list({o.size.x, o.size.y})},
            {"tolerance", kReferenceTolerance}};
}

/// And what a row depends on beyond its own settings.
Json rowsKey(const Stage& stage, const ErrorDesc& desc, Json key) {
    const Settings& s = stage.desc().settings;
    key.update({{"device", toJson(stage.caps())},
                {"texels", name(stage.scene().texels().format)},
                {"settings", toJson(s)},
                {"quick", desc.quick},
                {"frames", desc.frames}});
    return key;
}

Json conditions(const Stage& stage, const ErrorDesc& desc) {
    const StageDesc& o = stage.desc();
    return {{"size", Json::list({o.size.x, o.size.y})},
            {"camera", toJson(o.camera)},
            {"fov_degrees", o.fovDegrees},
            {"transfer_function", stage.scene().look().tf.name},
            {"settings", toJson(o.settings)},
            {"texel_format", name(stage.scene().texels().format)},
            {"quantisation_error", stage.scene().texels().maxQuantisationError},
            {"smallest_voxel_edge_mm", stage.scene().facts().smallestVoxelEdgeMm},
            {"frames_per_row_at_most", desc.frames},
            {"quick", desc.quick}};
}

/// From the store, or integrated and put there; its picture too.
Result<void> makeReference(const Stage& stage, ErrorStore& store, ReportFolder& folder) {
    if (store.reference() == nullptr) {
        const Stopwatch watch;
        StoredReference made;
        made.pixels = continuousPicture(stage);
        made.seconds = watch.ms() / 1000.0;
        if (Result<void> kept = store.setReference(std::move(made)); !kept) {
            return kept;
        }
    }
    const glm::ivec2 size = stage.desc().size;
    return folder.savePicture(kReferencePicture, {size, shown(store.reference()->pixels, size,
                                                              stage.scene().provided()->space)});
}

std::optional<double> timeOf(const Json& row) {
    return row.at("frame_ms").at("median").number();
}

std::optional<double> fetchesOf(const Json& row) {
    const Json& counters = row.at("counters");
    return counters.isNull() ? std::nullopt
                             : std::optional(counters.at("volume_fetches").number() +
                                             counters.at("skip_fetches").number());
}

/// What an error table keeps of the rows.
std::vector<MeasuredError> measuredOf(const Stage& stage, const std::vector<Sampling>& grid,
                                      const Json& rows, const RunInfo& run) {
    const glm::ivec2 size = stage.desc().size;
    const double megapixels = 1e-6 * size.x * size.y;
    const SceneLabel label = labelOf(stage);
    std::vector<MeasuredError> measured;
    for (const Sampling& sampling : grid) {
        for (const Json& row : rows) {
            if (row.at("id") == idOf(sampling)) {
                measured.push_back(
                    {label, size, sampling, totalRmse(row), *timeOf(row) / megapixels, run.commit});
            }
        }
    }
    return measured;
}

Result<ErrorStore> openStore(const Stage& stage, const ErrorDesc& desc, const RunInfo& run,
                             ReportFolder& folder) {
    const Json key = referenceKey(stage, run);
    return ErrorStore::open(folder,
                            {"error", stage.info().name, run.command, rowsKey(stage, desc, key)},
                            key, stage.watcher());
}

} // namespace

Result<std::vector<MeasuredError>> measureErrors(Stage& stage, const ErrorDesc& desc,
                                                 const RunInfo& run, ReportFolder& folder) {
    const std::string started = timestamp();
    Result<ErrorStore> opened = openStore(stage, desc, run, folder);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    ErrorStore& store = *opened;
    if (Result<void> made = makeReference(stage, store, folder); !made) {
        return tl::unexpected(made.error());
    }
    const std::vector<Sampling> grid = gridOf(desc.axes, desc.quick);
    Json leftOut;
    Result<Json> rows = errorRows(stage, desc, grid, store, folder, leftOut);
    if (!rows) {
        return tl::unexpected(rows.error());
    }
    addOrders(*rows);
    Json report = reportHeader(run, stage);
    const glm::ivec2 size = stage.desc().size;
    report.update({{"started", started},
                   {"left_out", std::move(leftOut)},
                   {"conditions", conditions(stage, desc)},
                   {"axes", toJson(desc.axes)},
                   {"reference",
                    {{"seconds", store.reference()->seconds},
                     {"tolerance", kReferenceTolerance},
                     {"size", Json::list({size.x, size.y})},
                     {"picture", kReferencePicture}}},
                   {"front", Json::listOf(frontOf(*rows, timeOf))},
                   {"front_by_fetches", Json::listOf(frontOf(*rows, fetchesOf))},
                   {"rows", *rows}});
    if (Result<void> added = addVerification(stage, desc, grid, folder, report); !added) {
        return tl::unexpected(added.error());
    }
    return folder
        .write("error.csv",
               csvOf(*rows, columnsOf({kColumns, kMomentColumns, kMeasuredColumns, kLastColumns})))
        .and_then([&] { return folder.write("error.json", report.dump(2) + "\n"); })
        .map([&] { return measuredOf(stage, grid, *rows, run); });
}

} // namespace slabcast

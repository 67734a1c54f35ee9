#include "perf/sweep/sweep.h"

#include <algorithm>

#include "core/plan/settings_table.h"
#include "perf/error/scene_key.h"
#include "perf/json.h"
#include "perf/model/predict_json.h"
#include "perf/number.h"
#include "perf/race.h"
#include "perf/run_store.h"
#include "perf/settings_json.h"
#include "perf/sweep/sweep_table.h"

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

std::string twoDigits(std::size_t index) {
    return (index < 10 ? "0" : "") + std::to_string(index);
}

/// Work of a row, and what a model makes of it for other GPUs; null where it cannot be counted.
struct RowWork {
    Json counters, model;
};
RowWork workOf(Stage& stage, const FramePlan& plan, const Settings& settings) {
    const Result<std::vector<PixelWork>> pixels = stage.workPerPixel(plan);
    if (!pixels) {
        return {};
    }
    WorkCounters counters;
    for (const PixelWork& pixel : *pixels) {
        counters += pixel;
    }
    const Result<std::vector<Prediction>> model = predictions(stage, settings, *pixels);
    return {toJson(Result<WorkCounters>(counters)), model ? toJson(*model) : Json()};
}

/// What is said of a row before it races: its plan, its first frame's time, work and thumbnail.
Result<Json> described(Stage& stage, const FramePlan& plan, const Settings& settings,
                       const std::string& thumbnailFile, ReportFolder& folder) {
    if (Result<void> ready = stage.prepare(plan); !ready) {
        return tl::unexpected(ready.error());
    }
    // Before any other is drawn: what drivers put off until then is this frame's.
    const Result<double> firstMs = stage.drawTimed(plan, 0.0);
    if (!firstMs) {
        return tl::unexpected(firstMs.error());
    }
    if (Result<void> saved =
            folder.savePicture(thumbnailFile, thumbnail(stage.desc().size, stage.picture(true)));
        !saved) {
        return tl::unexpected(saved.error());
    }
    RowWork work = workOf(stage, plan, settings);
    return Json{{"label", std::to_string(plan.planes) + "x" + std::to_string(plan.layersPerPlane)},
                {"classify", name(plan.variant.classification)},
                {"termination",
                 plan.variant.terminates ? fixed(plan.terminationAlpha, 4) : std::string("off")},
                {"lattice", name(plan.lattice.kind)},
                {"jitter", plan.lattice.jittered},
                {"planes", plan.planes},
                {"layers_per_plane", plan.layersPerPlane},
                {"form", plan.variant.unroll > 0 ? "unrolled" : "loop"},
                {"skip", name(plan.skip)},
                {"tighten", plan.tighten},
                {"counters", std::move(work.counters)},
                {"model", std::move(work.model)},
                {"compile_ms", stage.renderer().compileMs(plan.variant)},
                {"first_frame_ms", *firstMs},
                {"variant", name(plan.variant)},
                {"thumbnail", thumbnailFile}};
}

Json conditions(const Stage& stage, int rounds) {
    const StageDesc& o = stage.desc();
    const Settings& s = o.settings;
    const SceneFacts facts = stage.scene().facts();
    const int total = totalLayers(s, facts);
    Json all = conditionsOf(o);
    all.update(
        {{"transfer_function", stage.scene().look().tf.name},
         {"layer_spacing_mm", s.totalLayers ? 2.0 * facts.sphere.radiusMm / total
                                            : s.layerSpacingVoxels * facts.smallestVoxelEdgeMm},
         {"total_layers", total},
         {"rounds", rounds},
         {"views", o.stereoIpdMm ? 2 : 1}});
    return all;
}

/// The part of the report that is the same for all rows; taken last, when memory has seen its peak.
Json header(const Stage& stage, int rounds, const RunInfo& run) {
    Json result = reportHeader(run, stage);
    result.update({{"conditions", conditions(stage, rounds)},
                   {"memory", memoryOf(stage.renderer(), run)},
                   {"skip", toJson(stage.scene().skip())}});
    return result;
}

/// All that a row depends on, and which rows there are.
Json keyOf(const Stage& stage, const SweepDesc& desc, const RunInfo& run) {
    Json key = frameKey(stage.caps(), stage.scene(), stage.desc());
    key.update({{"commit", run.commit},
                {"layers_per_plane", Json::listOf(desc.layersPerPlane)},
                {"frames", desc.rounds}});
    return key;
}

/// The rows of a sweep, as they are planned, described and raced. Borrows all.
class SweepRun {
public:
    SweepRun(Stage& stage, const SweepDesc& desc, ReportFolder& folder, RunStore& store)
        : stage_(stage), desc_(desc), folder_(folder), store_(store), progress_(stage.watcher()) {}

    /// The rows of the report.
    Result<Json> measure(const std::vector<SweepRow>& rows) {
        return describe(rows).and_then([&](Json described) { return timed(std::move(described)); });
    }

    /// Of the rows that are drawn as the stage's own settings would be at their ratio.
    std::vector<RatioMeasurement> ratios() const {
        std::vector<RatioMeasurement> found;
        for (std::size_t k = 0; k < plans_.size(); ++k) {
            const FramePlan& row = plans_[k];
            Settings settings = stage_.desc().settings;
            settings.planes.reset();
            settings.layersPerPlane = row.layersPerPlane;
            const bool unrolled = row.variant.unroll > 0;
            settings.form = unrolled ? SegmentForm::Unrolled : SegmentForm::Loop;
            const Result<FramePlan> own = stage_.plan(settings);
            if (own && *own == row) {
                found.push_back({{row.planes, row.layersPerPlane, settings.form}, medians_[k]});
            }
        }
        return found;
    }

private:
    Result<Json> describe(const std::vector<SweepRow>& rows) {
        Json all = Json::list();
        for (const SweepRow& row : rows) {
            const Result<FramePlan> plan = stage_.plan(row.settings);
            if (!plan) {
                return tl::unexpected(plan.error());
            }
            const Result<Json> one = rowOf(*plan, row.settings, all.size(), rows.size());
            if (!one) {
                return one;
            }
            plans_.push_back(*plan);
            places_.push_back({row.series, plan->layersPerPlane});
            all.push_back(one->at("row"));
        }
        return all;
    }

    /// From the store, or as it is.
    Result<Json> rowOf(const FramePlan& plan, const Settings& settings, std::size_t index,
                       std::size_t count) {
        const std::string id = "row " + twoDigits(index);
        const std::string picture = std::string(kSweepThumbnails) + "/" + twoDigits(index) + ".png";
        if (const Json* kept = store_.find(id);
            kept != nullptr && kept->at("row").isObject() && folder_.has(picture)) {
            return *kept;
        }
        progress_.show("row " + std::to_string(index + 1) + " of " + std::to_string(count) + ": " +
                       std::to_string(plan.layersPerPlane) + " layers per plane, skip " +
                       name(plan.skip) + ", " + (plan.tighten ? "tight planes" : "10-gons"));
        return described(stage_, plan, settings, picture, folder_)
            .and_then([&](Json row) -> Result<Json> {
                Json piece = {{"id", id}, {"row", std::move(row)}};
                return store_.add(piece).map([&] { return std::move(piece); });
            });
    }

    Result<Json> timed(Json rows) {
        std::vector<Racer> racers;
        for (const FramePlan& plan : plans_) {
            racers.push_back({.plan = &plan});
        }
        const auto show = [this](int round, int rounds) {
            progress_.show("round " + std::to_string(round + 1) + " of " + std::to_string(rounds) +
                           ": a frame of every row");
        };
        return race(stage_, racers, {.id = "race", .rounds = desc_.rounds, .show = show}, store_)
            .map([&](const Laps& laps) {
                addTimes(rows, places_, laps);
                for (const std::vector<double>& times : laps) {
                    medians_.push_back(summarise(times).median);
                }
                return std::move(rows);
            });
    }

    Stage& stage_;
    const SweepDesc& desc_;
    ReportFolder& folder_;
    RunStore& store_;
    ProgressLine progress_;
    std::vector<FramePlan> plans_;
    std::vector<SweepPlace> places_;
    std::vector<double> medians_; // ms, of each row
};

} // namespace

std::vector<SweepRow> sweepRows(const Settings& settings, const SceneFacts& facts,
                                std::vector<int> lengths) {
    const int total = totalLayers(settings, facts);
    if (lengths.empty()) {
        lengths.assign(kUnrollLengths.begin(), kUnrollLengths.end());
        lengths.push_back(0);
    }
    std::vector<SweepRow> rows;
    int place = 0;
    for (const Series& series : seriesOf(settings, facts.skip.structure)) {
        for (const int length : lengths) {
            Settings row = settings;
            row.layersPerPlane = length == 0 ? total : std::min(length, total);
            row.skip = series.skip;
            row.tighten = series.tighten;
            // A list of lengths reaches beyond what can be written out: those rows are loops.
            row.form = unrollLengthFor(*row.layersPerPlane) == 0 ? SegmentForm::Loop : row.form;
            rows.push_back({row, place});
        }
        ++place;
    }
    return rows;
}

Result<std::vector<RatioMeasurement>> sweep(Stage& stage, const SweepDesc& desc, const RunInfo& run,
                                            ReportFolder& folder) {
    SLABCAST_EXPECTS(desc.rounds >= 1, desc.rounds);
    Result<RunStore> store =
        RunStore::open(folder, {"sweep", stage.info().name, run.command, keyOf(stage, desc, run)},
                       stage.watcher());
    if (!store) {
        return tl::unexpected(store.error());
    }
    SweepRun measuring(stage, desc, folder, *store);
    const Result<Json> rows = measuring.measure(
        sweepRows(stage.desc().settings, stage.scene().facts(), desc.layersPerPlane));
    if (!rows) {
        return tl::unexpected(rows.error());
    }
    Json report = header(stage, desc.rounds, run);
    report["rows"] = *rows;
    return folder.write("sweep.csv", sweepCsv(*rows))
        .and_then([&] { return folder.write("sweep.json", report.dump(2) + "\n"); })
        .map([&] { return measuring.ratios(); });
}

} // namespace slabcast

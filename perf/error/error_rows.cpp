#include "perf/error/error_rows.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/reference/flip.h"
#include "perf/error/reference_pictures.h"
#include "perf/error/worst_ray.h"

namespace slabcast {

namespace {

/// Of a row's frames: beyond this no more are timed than make a spread.
constexpr double kEnoughMs = 2000.0;
constexpr double kEnoughQuickMs = 300.0;

const char* ratioName(const FramePlan& plan) {
    return plan.planes == 1 ? "ray casting" : plan.layersPerPlane == 1 ? "slicing" : "hybrid";
}

Json planJson(const FramePlan& plan) {
    Json all = toJson(plan);
    all.erase("reasons");
    all["skip"] = name(plan.skip);
    return all;
}

/// Measures a grid's rows, or takes them from the store. Borrows all.
class ErrorRows {
public:
    ErrorRows(Stage& stage, const ErrorDesc& desc, ErrorStore& store, ReportFolder& folder,
              Json& leftOut)
        : stage_(stage), desc_(desc), store_(store), folder_(folder), leftOut_(leftOut),
          reference_(store.reference()->pixels), progress_(stage.watcher()),
          referenceSeen_(seen(reference_)) {}

    Result<Json> measure(const std::vector<Sampling>& grid);

private:
    /// Sampled in float64, once for all rows that take the same samples.
    struct Sampled {
        Lattice lattice;
        Classification classification = Classification::Post;
        std::vector<glm::dvec4> withTable;
        Json sampling, table; // the parts of the error
    };

    /// False where it cannot be had: it is left out from then on.
    bool classify(Classification classification);
    Result<Json> measureRow(const Sampling& sampling, const FramePlan& plan);
    const Sampled& sampledFor(const FramePlan& plan);
    Result<FrameTimes> time(const FramePlan& plan);
    Json countersOf(const FramePlan& plan);
    FlipPicture seen(const std::vector<glm::dvec4>& picture) const;
    Json flipOf(const std::vector<glm::dvec4>& picture) const;
    Result<Json> savePictures(const std::string& id, const std::vector<glm::dvec4>& picture);

    Stage& stage_;
    const ErrorDesc& desc_;
    ErrorStore& store_;
    ReportFolder& folder_;
    Json& leftOut_;
    const std::vector<glm::dvec4>& reference_;
    ProgressLine progress_;
    FlipPicture referenceSeen_;
    std::optional<Sampled> sampled_;
    std::vector<std::pair<FramePlan, Json>> counted_; // work does not depend on the target
};

Result<Json> ErrorRows::measure(const std::vector<Sampling>& grid) {
    Json rows = Json::list();
    std::vector<FramePlan> plans;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Sampling& sampling = grid[i];
        if (!classify(sampling.classification)) {
            continue;
        }
        const SceneFacts facts = stage_.scene().facts();
        const Result<FramePlan> plan =
            stage_.plan(withSampling(stage_.desc().settings, sampling, facts));
        if (!plan) {
            return tl::unexpected(plan.error());
        }
        if (std::find(plans.begin(), plans.end(), *plan) != plans.end()) {
            continue;
        }
        plans.push_back(*plan);
        const std::string id = idOf(sampling);
        if (store_.row(id) == nullptr) {
            progress_.show("row " + std::to_string(i + 1) + " of " + std::to_string(grid.size()) +
                           ": " + describe(sampling));
            Result<Json> row = measureRow(sampling, *plan);
            if (!row) {
                return row;
            }
            if (Result<void> kept = store_.add(std::move(*row)); !kept) {
                return tl::unexpected(kept.error());
            }
        }
        rows.push_back(*store_.row(id));
    }
    if (rows.empty()) {
        return fail(ErrorCode::VolumeTooLarge, leftOut_.at(0).at("why").text());
    }
    return rows;
}

bool ErrorRows::classify(Classification classification) {
    const auto isThis = [=](const Json& entry) {
        return entry.at("classify") == name(classification);
    };
    if (std::any_of(leftOut_.begin(), leftOut_.end(), isThis)) {
        return false;
    }
    const Result<void> look = stage_.reclassify(classification);
    if (!look) {
        leftOut_.push_back({{"classify", name(classification)}, {"why", look.error().detail}});
    }
    return look.has_value();
}

Result<Json> ErrorRows::measureRow(const Sampling& sampling, const FramePlan& plan) {
    if (Result<void> ready = stage_.prepare(plan); !ready) {
        return tl::unexpected(ready.error());
    }
    const Result<std::vector<glm::dvec4>> picture = stage_.drawOnNothing(plan); // and warms up
    if (!picture) {
        return tl::unexpected(picture.error());
    }
    const Result<FrameTimes> times = time(plan);
    if (!times) {
        return tl::unexpected(times.error());
    }
    const Sampled& sampled = sampledFor(plan);
    Json error = {{"total", toJson(difference(*picture, reference_, plan.space))},
                  {"sampling", sampled.sampling},
                  {"table", sampled.table},
                  {"gpu", toJson(difference(*picture, sampled.withTable, plan.space))}};
    const std::string id = idOf(sampling);
    Result<Json> pictures = savePictures(id, *picture);
    if (!pictures) {
        return pictures;
    }
    Json row = toJson(sampling);
    row.update({{"id", id},
                {"date", timestamp()},
                {"ratio", ratioName(plan)},
                {"plan", planJson(plan)},
                {"error", std::move(error)},
                {"flip", flipOf(*picture)},
                {"worst_pixel", worstPixel(*picture, reference_, stage_.desc().size)},
                {"frame_ms", toJson(*times)},
                {"counters", countersOf(plan)},
                {"command", desc_.commandOf ? desc_.commandOf(sampling, plan, id + ".png") : ""},
                {"pictures", std::move(*pictures)}});
    return row;
}

const ErrorRows::Sampled& ErrorRows::sampledFor(const FramePlan& plan) {
    const Classification classification = plan.variant.classification;
    if (!sampled_ || sampled_->lattice != plan.lattice ||
        sampled_->classification != classification) {
        const auto pictureOf = [&](TransferKind kind) {
            return discretePicture(stage_, plan.lattice, kind);
        };
        const std::vector<glm::dvec4> continuous = pictureOf(TransferKind::Continuous);
        sampled_ = {plan.lattice, classification, pictureOf(TransferKind::Table), {}, {}};
        sampled_->sampling = toJson(difference(continuous, reference_, plan.space));
        sampled_->table = toJson(difference(sampled_->withTable, continuous, plan.space));
    }
    return *sampled_;
}

FlipPicture ErrorRows::seen(const std::vector<glm::dvec4>& picture) const {
    return flipPicture(picture, stage_.desc().size, stage_.scene().provided()->space);
}

Json ErrorRows::flipOf(const std::vector<glm::dvec4>& picture) const {
    const std::vector<double> pixels = flip(seen(picture), referenceSeen_);
    double sum = 0.0;
    for (const double pixel : pixels) {
        sum += pixel;
    }
    return {{"mean", sum / static_cast<double>(pixels.size())},
            {"max", *std::max_element(pixels.begin(), pixels.end())},
            {"pixels_per_degree", kPixelsPerDegree}};
}

Result<FrameTimes> ErrorRows::time(const FramePlan& plan) {
    const double enoughMs = desc_.quick ? kEnoughQuickMs : kEnoughMs;
    const auto frames = static_cast<std::size_t>(desc_.frames);
    std::vector<double> times;
    for (double spentMs = 0.0; times.size() < std::size_t{kFewestFrames} ||
                               (times.size() < frames && spentMs < enoughMs);) {
        const Result<double> ms = stage_.drawTimed(plan, 0.0);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        times.push_back(*ms);
        spentMs += *ms;
    }
    return summarise(std::move(times));
}

Json ErrorRows::countersOf(const FramePlan& plan) {
    FramePlan work = plan;
    work.target = TargetFormat::Rgba8;
    const auto known = std::find_if(counted_.begin(), counted_.end(),
                                    [&work](const auto& entry) { return entry.first == work; });
    if (known != counted_.end()) {
        return known->second;
    }
    return counted_.emplace_back(work, toJson(stage_.countWork(plan))).second;
}

Result<Json> ErrorRows::savePictures(const std::string& id,
                                     const std::vector<glm::dvec4>& picture) {
    const AmplifiedDifference apart = amplified(picture, reference_, stage_.desc().size);
    const std::string thumbnailFile = std::string(kErrorPictures) + "/" + id + ".png";
    const std::string differenceFile = std::string(kErrorPictures) + "/" + id + "_difference.png";
    const auto save = [this](const std::string& file, const std::vector<glm::vec4>& pixels) {
        return folder_.savePicture(file, thumbnail(stage_.desc().size, pixels));
    };
    const auto failure = [](const Result<void>& result) { return tl::unexpected(result.error()); };
    const CompositingSpace space = stage_.scene().provided()->space;
    if (Result<void> saved = save(thumbnailFile, shown(picture, stage_.desc().size, space));
        !saved) {
        return failure(saved);
    }
    if (Result<void> saved = save(differenceFile, apart.pixels); !saved) {
        return failure(saved);
    }
    return Json{{"thumbnail", thumbnailFile},
                {"difference", differenceFile},
                {"difference_factor", apart.factor}};
}

} // namespace

Result<Json> errorRows(Stage& stage, const ErrorDesc& desc, const std::vector<Sampling>& grid,
                       ErrorStore& store, ReportFolder& folder, Json& leftOut) {
    leftOut = Json::list();
    return ErrorRows(stage, desc, store, folder, leftOut).measure(grid);
}

} // namespace slabcast

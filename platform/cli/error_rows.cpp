#include "platform/cli/error_rows.h"

#include <algorithm>

#include <fmt/core.h>

#include "perf/csv.h"
#include "perf/frame_times.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "platform/cli/command_line.h"
#include "platform/cli/error_grid.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/reference_pictures.h"
#include "platform/cli/report_files.h"

namespace slabcast {

namespace {

using nlohmann::json;

/// Of a row's frames: beyond this no more are timed than make a spread.
constexpr double kEnoughMs = 2000.0;
constexpr double kEnoughQuickMs = 300.0;

const char* ratioName(const FramePlan& plan) {
    return plan.planes == 1 ? "ray casting" : plan.layersPerPlane == 1 ? "slicing" : "hybrid";
}

json planJson(const FramePlan& plan) {
    json all = toJson(plan);
    all.erase("reasons");
    all["skip"] = name(plan.skip);
    return all;
}

} // namespace

Result<json> ErrorRows::measure(const std::vector<Sampling>& grid) {
    json rows = json::array();
    std::vector<FramePlan> plans;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Sampling& sampling = grid[i];
        if (!classify(sampling.classification)) {
            continue;
        }
        const SceneFacts facts = stage_.scene().facts();
        const Result<FramePlan> plan = slabcast::plan(
            facts, withSampling(options_.settings, sampling, facts), stage_.caps(), {});
        if (!plan) {
            return tl::unexpected(plan.error());
        }
        if (std::find(plans.begin(), plans.end(), *plan) != plans.end()) {
            continue;
        }
        plans.push_back(*plan);
        const std::string id = idOf(sampling);
        if (store_.row(id) == nullptr) {
            progress_.show(fmt::format("row {} of {}: {}", i + 1, grid.size(), describe(sampling)));
            Result<json> row = measureRow(sampling, *plan);
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
        return fail(ErrorCode::InvalidArgument, leftOut_.at(0).at("why"));
    }
    return rows;
}

bool ErrorRows::classify(Classification classification) {
    const auto isThis = [=](const json& entry) {
        return entry.at("classification") == name(classification);
    };
    if (std::any_of(leftOut_.begin(), leftOut_.end(), isThis)) {
        return false;
    }
    const Result<void> look = stage_.reclassify(classification);
    if (!look) {
        leftOut_.push_back(
            {{"classification", name(classification)}, {"why", look.error().detail}});
    }
    return look.has_value();
}

Result<json> ErrorRows::measureRow(const Sampling& sampling, const FramePlan& plan) {
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
    json error = {{"total", toJson(difference(*picture, reference_, plan.space))},
                  {"sampling", sampled.sampling},
                  {"table", sampled.table},
                  {"gpu", toJson(difference(*picture, sampled.withTable, plan.space))}};
    const std::string id = idOf(sampling);
    Result<json> pictures = savePictures(id, *picture);
    if (!pictures) {
        return pictures;
    }
    json row = toJson(sampling);
    row.update({{"id", id},
                {"date", timestamp()},
                {"ratio", ratioName(plan)},
                {"plan", planJson(plan)},
                {"error", std::move(error)},
                {"frameMs", toJson(*times)},
                {"counters", countersOf(plan)},
                {"command", renderCommandLine(options_, sampling, plan, id + ".png")},
                {"pictures", std::move(*pictures)}});
    return row;
}

const ErrorRows::Sampled& ErrorRows::sampledFor(const FramePlan& plan) {
    const Classification classification = plan.variant.classification;
    if (!sampled_ || sampled_->lattice != plan.lattice ||
        sampled_->classification != classification) {
        const auto pictureOf = [&](TransferKind kind) {
            return discretePicture(stage_, options_.size, plan.lattice, kind);
        };
        const std::vector<glm::dvec4> continuous = pictureOf(TransferKind::Continuous);
        sampled_ = {plan.lattice, classification, pictureOf(TransferKind::Table), {}, {}};
        sampled_->sampling = toJson(difference(continuous, reference_, plan.space));
        sampled_->table = toJson(difference(sampled_->withTable, continuous, plan.space));
    }
    return *sampled_;
}

Result<FrameTimes> ErrorRows::time(const FramePlan& plan) {
    const double enoughMs = options_.quick ? kEnoughQuickMs : kEnoughMs;
    const auto frames = static_cast<std::size_t>(options_.frames);
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

json ErrorRows::countersOf(const FramePlan& plan) {
    FramePlan work = plan;
    work.target = TargetFormat::Rgba8;
    const auto known = std::find_if(counted_.begin(), counted_.end(),
                                    [&work](const auto& entry) { return entry.first == work; });
    if (known != counted_.end()) {
        return known->second;
    }
    return counted_.emplace_back(work, toJson(stage_.countWork(plan))).second;
}

Result<json> ErrorRows::savePictures(const std::string& id,
                                     const std::vector<glm::dvec4>& picture) {
    const AmplifiedDifference apart = amplified(picture, reference_, options_.size);
    const std::string thumbnailFile = fmt::format("pictures/{}.png", id);
    const std::string differenceFile = fmt::format("pictures/{}_difference.png", id);
    const auto save = [this](const std::string& file, const std::vector<glm::vec4>& pixels) {
        const ReportPicture small = thumbnail(options_.size, pixels);
        return savePicture(std::filesystem::path(options_.outputFolder) / file, small.size,
                           small.pixels, true);
    };
    const auto failure = [](const Result<void>& result) { return tl::unexpected(result.error()); };
    const CompositingSpace space = stage_.scene().look().space;
    if (Result<void> saved = save(thumbnailFile, shown(picture, options_.size, space)); !saved) {
        return failure(saved);
    }
    if (Result<void> saved = save(differenceFile, apart.pixels); !saved) {
        return failure(saved);
    }
    return json{{"thumbnail", thumbnailFile},
                {"difference", differenceFile},
                {"differenceFactor", apart.factor}};
}

} // namespace slabcast

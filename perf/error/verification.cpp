#include "perf/error/verification.h"

#include <algorithm>

#include "perf/error/convergence.h"
#include "perf/error/predicted_step.h"
#include "perf/error/refinement.h"
#include "perf/error/worst_ray.h"

namespace slabcast {

namespace {

/// Two points at one value that differ.
bool hasSteps(const TransferFunction& tf) {
    const auto step = [](const TransferPoint& a, const TransferPoint& b) {
        return a.value == b.value && (a.opacity != b.opacity || a.color != b.color);
    };
    return std::adjacent_find(tf.points.begin(), tf.points.end(), step) != tf.points.end();
}

Result<Json> refinement(const Stage& stage, ReportFolder& folder) {
    ProgressLine progress(stage.watcher());
    progress.show("refining step, grid and pixel");
    std::vector<RefinementStudy> studies = refine();
    Result<std::vector<RefinementStudy>> ofDevice = refineOnDevice(stage.device());
    if (ofDevice) {
        studies.insert(studies.end(), ofDevice->begin(), ofDevice->end());
    }
    Json report = toJson(studies);
    report["device_refused"] = ofDevice ? Json() : Json(ofDevice.error().detail);
    report["csv"] = "refinement.csv";
    return folder.write("refinement.csv", refinementCsv(studies)).map([&] { return report; });
}

Json prediction(const Stage& stage, const Json& rows) {
    const Scene& scene = stage.scene();
    const VolumeStatistics& statistics = scene.statistics();
    return predictedStep(predictStep(stage.values(), scene.geometry(), scene.look().tf,
                                     statistics.min, statistics.max),
                         scene.facts().smallestVoxelEdgeMm, rows);
}

} // namespace

Result<void> addVerification(Stage& stage, const ErrorDesc& desc, const std::vector<Sampling>& grid,
                             ReportFolder& folder, Json& report) {
    // A member that is made moves the others: each is looked up anew.
    report["convergence"] = familyConvergence(report.at("rows"), hasSteps(stage.scene().look().tf));
    report["predicted_step"] = prediction(stage, report.at("rows"));
    report["refinement"] = nullptr;
    report["worst_ray"] = nullptr;
    if (!desc.verification) {
        return {};
    }
    Result<Json> refined = refinement(stage, folder);
    if (!refined) {
        return tl::unexpected(refined.error());
    }
    report["refinement"] = std::move(*refined);
    return traceWorstRay(stage, grid, report.at("rows"), folder).map([&](Json ray) {
        report["worst_ray"] = std::move(ray);
    });
}

} // namespace slabcast

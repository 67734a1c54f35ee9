#include "perf/frame/frame_report.h"

#include <algorithm>
#include <numeric>

#include "perf/error/reference_pictures.h"
#include "perf/json.h"
#include "perf/settings_json.h"

namespace slabcast {

Result<Turn> drawTurn(Stage& stage, const FramePlan& plan, int frames, bool encoded) {
    if (frames > 1) {
        (void)stage.drawTimed(
            plan, 0.0); // the first frame after a compile also pays for the driver's own work
    }
    Turn turn;
    ProgressLine progress(stage.watcher());
    for (int k = 0; k < frames; ++k) {
        progress.show("frame " + std::to_string(k + 1) + " of " + std::to_string(frames));
        const Result<double> ms = stage.drawTimed(plan, 360.0 * k / frames);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        turn.frameMs.push_back(*ms);
        if (k == 0) {
            turn.firstPicture = stage.picture(encoded);
        }
    }
    return turn;
}

Result<PictureDifference> errorOf(Stage& stage, const FramePlan& plan) {
    return stage.drawOnNothing(plan).map([&](const std::vector<glm::dvec4>& picture) {
        return difference(picture, continuousPicture(stage), plan.space);
    });
}

Result<CostPicture> drawCosts(Stage& stage, const FramePlan& plan, HeatmapQuantity quantity,
                              const HeatmapScale& scale, bool encoded) {
    const Result<std::vector<PixelWork>> work = stage.workPerPixel(plan);
    if (!work) {
        return tl::unexpected(work.error());
    }
    std::vector<double> costs(work->size());
    std::transform(work->begin(), work->end(), costs.begin(),
                   [=](const PixelWork& pixel) { return costOf(pixel, quantity); });
    const double maximum = maximumOf(scale, costs, plan.lattice.total);
    CostPicture picture{drawHeatmap(stage.desc().size, costs, quantity, maximum), quantity, maximum,
                        std::accumulate(costs.begin(), costs.end(), 0.0)};
    if (!encoded) {
        for (glm::vec4& pixel : picture.pixels) {
            pixel = glm::vec4(glm::vec3(linearFromSrgb(glm::dvec3(pixel))), pixel.a);
        }
    }
    return picture;
}

std::string frameReport(Stage& stage, const FramePlan& plan, const Settings& settings,
                        const FrameFindings& findings, const RunInfo& run) {
    Json skip = toJson(stage.scene().skip());
    if (!skip.isNull()) {
        skip["skips"] = plan.skip != SkipStructure::None; // what the plan has a use for
        skip["tightens"] = plan.tighten;
    }
    Json report = {{"device", toJson(stage.caps())},
                   {"commit", run.commit},
                   {"volume", toJson(stage.info())},
                   {"plan", toJson(plan)},
                   {"settings", toJson(settings)},
                   {"skip", std::move(skip)},
                   {"frame_ms", toJson(summarise(findings.frameMs))},
                   {"counters", toJson(stage.countWork(plan))},
                   {"compile_ms", stage.renderer().compileMs(plan.variant)},
                   {"quantisation_error", stage.scene().texels().maxQuantisationError},
                   {"memory", memoryOf(stage.renderer(), run)}};
    if (findings.error) {
        report["error"] = toJson(*findings.error);
    }
    if (findings.costs != nullptr) {
        report["heatmap"] = {{"quantity", name(findings.costs->quantity)},
                             {"maximum", findings.costs->maximum},
                             {"sum", findings.costs->sum}};
    }
    return report.dump(2) + "\n";
}

} // namespace slabcast

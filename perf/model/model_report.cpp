#include "perf/model/model_report.h"

#include <algorithm>

#include "perf/model/headsets.h"
#include "perf/model/paper_model.h"
#include "perf/model/predict_json.h"
#include "perf/number.h"
#include "perf/settings_json.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

std::vector<int> lengthsOf(const ModelDesc& desc) {
    if (!desc.layersPerPlane.empty()) {
        return desc.layersPerPlane;
    }
    std::vector<int> lengths(kUnrollLengths.begin(), kUnrollLengths.end());
    lengths.push_back(0);
    return lengths;
}

/// By pixels of a wave: how many times as many layers and looks waves do, at least.
Json divergenceByWave(std::span<const Prediction> predictions) {
    Json all = Json::object();
    for (const Prediction& one : predictions) {
        all["wave_" + std::to_string(one.gpu->waveWidth * one.gpu->waveHeight)] =
            Json::list({one.work.layerDivergence, one.work.lookDivergence});
    }
    return all;
}

/// A ratio on one headset. Null where the compilers' figures lack its shader.
Result<Json> rowOf(Stage& stage, const GpuRates& gpu, int length) {
    Settings settings = stage.desc().settings;
    const int total = totalLayers(settings, stage.scene().facts());
    settings.planes.reset();
    settings.layersPerPlane = length == 0 ? total : std::min(length, total);
    const Result<FramePlan> plan = planOn(gpu, stage, settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    const Result<std::vector<Prediction>> all =
        stage.prepare(*plan)
            .and_then([&] { return stage.workPerPixel(*plan); })
            .and_then([&](const std::vector<PixelWork>& pixels) {
                return predictions(stage, settings, pixels);
            });
    if (!all) {
        return tl::unexpected(all.error());
    }
    for (const Prediction& one : *all) {
        if (one.gpu == &gpu) {
            Json row = toJson(std::span(&one, 1)).at(gpu.name);
            row.update({{"planes", one.plan.planes},
                        {"layers_per_plane", one.plan.layersPerPlane},
                        {"total_layers", total},
                        {"skip", name(one.plan.skip)},
                        {"fragments", one.work.fragments},
                        {"rays", one.work.rays},
                        {"layers_evaluated", one.work.layers},
                        {"volume_fetches", one.work.volumeFetches},
                        {"skip_fetches", one.work.looks},
                        {"volume_bytes", one.work.volumeBytes},
                        {"divergence_by_wave", divergenceByWave(*all)}});
            return row;
        }
    }
    return Json();
}

std::string lineOf(const Headset& headset, const Json& best) {
    const double ms = best.at("frame_ms").number();
    std::string line =
        std::string("model: ") + headset.name + ", both eyes of " +
        std::to_string(headset.eyePixels.x) + "x" + std::to_string(headset.eyePixels.y) + ": " +
        fixed(ms, 2) + " ms (" + fixed(best.at("low_ms").number(), 2) + " to " +
        fixed(best.at("high_ms").number(), 2) + "), " + std::to_string(best.at("planes").whole()) +
        "x" + std::to_string(best.at("layers_per_plane").whole()) + ", held back by " +
        best.at("limit").text();
    for (const double rate : kHeadsetRates) {
        line += "; " + fixed(rate, 0) + " Hz: " + (ms <= 1e3 / rate ? "yes" : "no");
    }
    return line;
}

struct HeadsetReport {
    Json json;
    std::string line;
};

Result<HeadsetReport> headsetReport(Stage& stage, const Headset& headset,
                                    const std::vector<int>& lengths) {
    const GpuRates& gpu = *findGpuRates(headset.gpu);
    stage.resize({2 * headset.eyePixels.x, headset.eyePixels.y});
    Json rows = Json::list();
    const Json* best = nullptr;
    ProgressLine progress(stage.watcher());
    for (const int length : lengths) {
        progress.show(std::string(headset.name) + ", " +
                      (length == 0 ? "all layers" : std::to_string(length) + " layers per plane"));
        const Result<Json> row = rowOf(stage, gpu, length);
        if (!row) {
            return tl::unexpected(row.error());
        }
        if (!row->isNull()) {
            rows.push_back(*row);
        }
    }
    for (const Json& row : rows) {
        const bool better =
            best == nullptr || row.at("frame_ms").number() < best->at("frame_ms").number();
        best = better ? &row : best;
    }
    const std::string line = best != nullptr ? lineOf(headset, *best)
                                             : std::string("model: ") + headset.name +
                                                   ": its compiler's figures lack these shaders";
    Json json = {{"name", headset.name},
                 {"gpu", headset.gpu},
                 {"eye_pixels", Json::list({headset.eyePixels.x, headset.eyePixels.y})},
                 {"source", headset.source},
                 {"rates_source", gpu.source},
                 {"best", best != nullptr ? *best : Json()}};
    json["rows"] = std::move(rows);
    return HeadsetReport{std::move(json), line};
}

Json toJson(const PaperRow& row) {
    return {{"layers_per_plane", row.settings.layersPerPlane},
            {"skips", row.settings.skips},
            {"fragments", row.work.fragments},
            {"segments", row.work.segments},
            {"layers", row.work.layers},
            {"leaps", row.work.leaps},
            {"box_tests", row.work.boxTests},
            {"fetches", row.work.fetches},
            {"fetches_alone", row.work.fetchesAlone}};
}

Json toJson(const PaperFigure& figure) {
    return {{"method", figure.method},
            {"published_fps", figure.publishedFps},
            {"model_fps", figure.modelFps},
            {"layers_per_plane", figure.settings.layersPerPlane},
            {"limit", figure.terms.limit},
            {"issue_ms", figure.terms.issueMs},
            {"texture_ms", figure.terms.textureMs},
            {"fragment_ms", figure.terms.fragmentMs},
            {"blend_ms", figure.terms.blendMs},
            {"memory_ms", figure.terms.memoryMs},
            {"divergence_ms", figure.terms.divergenceMs},
            {"code_high_ms", figure.terms.codeHighMs}};
}

template <class Items>
Json listOf(const Items& items) {
    Json all = Json::list();
    for (const auto& item : items) {
        all.push_back(toJson(item));
    }
    return all;
}

} // namespace

Result<std::vector<std::string>> modelReport(Stage& stage, const ModelDesc& desc,
                                             const RunInfo& run, ReportFolder& folder) {
    SLABCAST_EXPECTS(stage.desc().stereoIpdMm.has_value(), 0);
    std::vector<std::string> lines;
    Json headsets = Json::list();
    for (const Headset& headset : kHeadsets) {
        Result<HeadsetReport> one = headsetReport(stage, headset, lengthsOf(desc));
        if (!one) {
            return tl::unexpected(one.error());
        }
        headsets.push_back(std::move(one->json));
        lines.push_back(std::move(one->line));
    }
    const std::vector<PaperRow> rows = paperRows(desc.paper);
    const std::vector<PaperFigure> figures = paperFigures(rows);
    for (const PaperFigure& figure : figures) {
        lines.push_back(std::string("model: the paper's ") + figure.method + ": " +
                        fixed(figure.modelFps, 1) + " fps, published " +
                        fixed(figure.publishedFps, 1));
    }
    Json report = reportHeader(run, stage);
    report.update({{"conditions", conditionsOf(stage.desc())},
                   {"headsets", std::move(headsets)},
                   {"paper",
                    {{"share_of_screen", kPaperShare},
                     {"figures", listOf(figures)},
                     {"rows", listOf(rows)}}}});
    return folder.write("model.json", report.dump(2) + "\n").map([&] { return std::move(lines); });
}

} // namespace slabcast

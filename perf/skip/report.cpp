#include "perf/skip/report.h"

#include "perf/csv.h"
#include "perf/json.h"
#include "perf/report_json.h"
#include "perf/settings_json.h"
#include "perf/skip/figures.h"
#include "perf/skip/papers.h"
#include "perf/skip/row_json.h"

namespace slabcast::skipbench {

namespace {

constexpr CsvColumn kColumns[] = {{"table", "/table"},
                                  {"volume", "/volume"},
                                  {"edge", "/edge"},
                                  {"family", "/family"},
                                  {"mode", "/mode"},
                                  {"finals_of", "/finals_of"},
                                  {"skip", "/skip"},
                                  {"skip_block", "/skip_block"},
                                  {"skip_bits", "/skip_bits"},
                                  {"partitions", "/partitions"},
                                  {"initial_level", "/initial_level"},
                                  {"traversal", "/traversal"},
                                  {"tf", "/tf"},
                                  {"tf_name", "/tf_name"},
                                  {"planes", "/planes"},
                                  {"layers_per_plane", "/layers_per_plane"},
                                  {"tighten", "/tighten"},
                                  {"order", "/order"},
                                  {"search_ms", "/search_ms"},
                                  {"speedup", "/speedup"},
                                  {"speedup_low", "/speedup_low"},
                                  {"speedup_high", "/speedup_high"},
                                  {"speedup_coverage", "/speedup_coverage"},
                                  {"speedup_of_ranges", "/speedup_of_ranges"},
                                  {"speedup_of_ranges_low", "/speedup_of_ranges_low"},
                                  {"speedup_of_ranges_high", "/speedup_of_ranges_high"},
                                  {"build_ms", "/build_ms/median"},
                                  {"build_ms_min", "/build_ms/min"},
                                  {"build_ms_max", "/build_ms/max"},
                                  {"gpu_build_ms", "/gpu_build_ms/median"},
                                  {"gpu_build_ms_min", "/gpu_build_ms/min"},
                                  {"gpu_build_ms_max", "/gpu_build_ms/max"},
                                  {"gpu_refused", "/gpu_refused"},
                                  {"build_of_ranges_ms", "/of_ranges_ms/median"},
                                  {"init_ms", "/init_ms"},
                                  {"update_ms", "/update_ms/median"},
                                  {"gpu_bytes", "/gpu_bytes"},
                                  {"host_bytes", "/host_bytes"},
                                  {"occupied_fraction", "/occupied_fraction"},
                                  {"refused", "/refused"}};

const char* name(Modality modality) {
    return modality == Modality::Ct ? "ct" : modality == Modality::Mr ? "mr" : "unknown";
}

Json volumeJson(const VolumeRecord& record) {
    Json volume = slabcast::toJson(record.info);
    volume.update({{"name", record.name},
                   {"input", record.input},
                   {"modality", name(record.info.modality)},
                   {"transfer_function", record.transferFunction},
                   {"texel_format", name(record.texelFormat)},
                   {"texel_bytes", record.texelBytes},
                   {"codes_ms", record.codesMs},
                   {"own_scene", record.own != OwnScene::None}});
    return volume;
}

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

/// What programs ask of a figure.
Json judgement(const Figure& figure) {
    const auto& interval = figure.interval;
    return {{"value", orNull(figure.value)},
            {"low", interval ? Json(interval->low) : Json()},
            {"high", interval ? Json(interval->high) : Json()},
            {"coverage", interval ? Json(interval->coverage) : Json()},
            {"goal", orNull(figure.goal)},
            {"sense", name(figure.sense)},
            {"reached", orNull(figure.reached())}};
}

Json figureJson(const Figure& figure) {
    Json all = judgement(figure);
    all.update({{"key", figure.key},
                {"name", figure.name},
                {"volume", figure.volume},
                {"from", figure.from}});
    return all;
}

template <class T>
Json listOf(std::span<const T> items, Json (*asJson)(const T&)) {
    Json list = Json::list();
    for (const T& item : items) {
        list.push_back(asJson(item));
    }
    return list;
}

/// Numbers alone, by the names of volumes and figures.
Json summaryOf(std::span<const Figure> figures) {
    const Tally tally = tallyOf(figures);
    Json volumes = Json::object();
    for (const Figure& figure : figures) {
        volumes[figure.volume][figure.key] = judgement(figure);
    }
    return {{"judged", tally.judged}, {"reached", tally.reached}, {"volumes", std::move(volumes)}};
}

Json conditionsOf(const Desc& desc) {
    Json all = slabcast::conditionsOf(desc.stage);
    all.update({{"frames_per_row_at_most", desc.frames},
                {"partition_budget_bytes", desc.stage.settings.skipOptions.memoryBudgetBytes},
                {"sizes", Json::listOf(desc.sizes)},
                {"quick", desc.quick}});
    return all;
}

} // namespace

Report reportOf(const Desc& desc, const Measured& measured, const RunInfo& info,
                const gl::Caps& caps) {
    Json report = reportHeader(info, caps);
    report["conditions"] = conditionsOf(desc);
    report["volumes"] = listOf(measured.volumes, volumeJson);
    report["figures"] = listOf(measured.figures, figureJson);
    report["summary"] = summaryOf(measured.figures);
    report["papers"] = publishedTables();
    report["rows"] = listOf(measured.rows, toJson);
    return {.json = report.dump(2) + "\n",
            .csv = csvOf(report["rows"], columnsOf({kColumns, kMeasuredColumns})),
            .line = lineOf(measured.figures)};
}

} // namespace slabcast::skipbench

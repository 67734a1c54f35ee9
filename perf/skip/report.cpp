#include "perf/skip/report.h"

#include "perf/csv.h"
#include "perf/json.h"
#include "perf/report_json.h"
#include "perf/skip/figures.h"
#include "perf/skip/papers.h"
#include "perf/skip/row.h"

namespace slabcast::skipbench {

namespace {

constexpr CsvColumn kColumns[] = {{"table", "/table"},
                                  {"volume", "/volume"},
                                  {"edge", "/edge"},
                                  {"family", "/family"},
                                  {"mode", "/mode"},
                                  {"finals_of", "/finals_of"},
                                  {"structure", "/structure"},
                                  {"block_edge", "/block_edge"},
                                  {"bits", "/bits"},
                                  {"partitions", "/partitions"},
                                  {"initial_level", "/initial_level"},
                                  {"traversal", "/traversal"},
                                  {"tf", "/tf"},
                                  {"tf_name", "/tf_name"},
                                  {"planes", "/planes"},
                                  {"layers_per_plane", "/layers_per_plane"},
                                  {"tighten", "/tighten"},
                                  {"order", "/order"},
                                  {"search_ms", "/ms"},
                                  {"speedup", "/speedup"},
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

const char* name(Table table) {
    constexpr const char* kNames[] = {"search",     "finals",     "frames",  "ratios", "work",
                                      "structures", "partitions", "rebuild", "merge",  "sizes"};
    return kNames[static_cast<int>(table)];
}

const char* name(Modality modality) {
    return modality == Modality::Ct ? "ct" : modality == Modality::Mr ? "mr" : "unknown";
}

Json timesOf(const std::vector<double>& ms) {
    return toJson(summarise(ms));
}

/// Structure and parameters: no others than the structure's own.
Json fieldsOf(const SkipOptions& o) {
    Json row{{"structure", name(o.structure)}};
    if (o.structure != SkipStructure::None) {
        row["block_edge"] = o.blockEdgeVoxels;
    }
    if (o.structure == SkipStructure::BitfieldOctree) {
        row["bits"] = o.bits;
    }
    if (o.structure == SkipStructure::Partitioned) {
        row["partitions"] = o.partitions;
    }
    if (isOctree(o.structure)) {
        row["initial_level"] = o.initialLevel;
        row["traversal"] = name(o.traversal);
    }
    return row;
}

Json fieldsOf(const FramePlan& plan) {
    return {{"planes", plan.planes},
            {"layers_per_plane", plan.layersPerPlane},
            {"tighten", plan.tighten},
            {"order", name(plan.order)},
            {"variant", name(plan.variant)}};
}

Json fieldsOf(const Cube& cube) {
    return {{"edge", cube.edge}, {"volume_bytes", cube.volumeBytes}, {"codes_ms", cube.codesMs}};
}

Json fieldsOf(const Raced& raced) {
    return {{"frame_ms", timesOf(raced.samples)},
            {"samples", Json::listOf(raced.samples)},
            {"speedup", raced.speedup}};
}

Json fieldsOf(const Memory& memory) {
    return {{"gpu_bytes", memory.gpuBytes}, {"host_bytes", memory.hostBytes}};
}

Json fieldsOf(const Build& build) {
    Json row{{"gpu_build_ms", timesOf(build.gpuMs)}};
    if (!build.gpuRefused.empty()) {
        row["gpu_refused"] = build.gpuRefused;
    }
    if (!build.refused.empty()) {
        row["refused"] = build.refused;
        return row;
    }
    row.update({{"build_ms", timesOf(build.ms)},
                {"update_ms", timesOf(build.updateMs)},
                {"occupied_fraction", build.occupiedFraction}});
    row.update(fieldsOf(build.memory));
    return row;
}

Json fieldsOf(const Partitions& partitions) {
    if (!partitions.refused.empty()) {
        return {{"refused", partitions.refused}};
    }
    Json row = fieldsOf(partitions.memory);
    row["init_ms"] = partitions.initMs;
    return row;
}

Json fieldsOf(const Transfer& transfer) {
    return {{"tf", transfer.key}, {"tf_name", transfer.name}};
}

Json fieldsOf(const Rebuild& rebuild) {
    return {{"build_ms", timesOf(rebuild.ms)}, {"of_ranges_ms", timesOf(rebuild.ofRangesMs)}};
}

Json fieldsOf(const Merge& merge) {
    return {{"update_ms", timesOf(merge.ms)},
            {"speedup", merge.speedup},
            {"speedup_of_ranges", merge.speedupOfRanges}};
}

Json fieldsOf(const Row& row) {
    Json all = fieldsOf(row.options);
    all.update({{"table", name(row.table)}, {"volume", row.volume}});
    const auto addIf = [&all](const auto& part) {
        if (part) {
            all.update(fieldsOf(*part));
        }
    };
    addIf(row.cube);
    addIf(row.plan);
    addIf(row.raced);
    addIf(row.build);
    addIf(row.partitions);
    addIf(row.transfer);
    addIf(row.rebuild);
    addIf(row.merge);
    if (row.family != nullptr) {
        all["family"] = row.family;
    }
    if (row.mode != nullptr) {
        all["mode"] = row.mode;
    }
    if (row.finalsOf) {
        all["finals_of"] = name(*row.finalsOf);
    }
    if (row.leastMs) {
        all["ms"] = *row.leastMs;
    }
    if (row.counters) {
        all["counters"] = toJson(*row.counters);
    }
    return all;
}

Json fieldsOf(const VolumeRecord& record) {
    Json volume = toJson(record.info);
    volume.update({{"name", record.name},
                   {"input", record.input},
                   {"modality", name(record.info.modality)},
                   {"transfer_function", record.transferFunction},
                   {"texel_format", name(record.texelFormat)},
                   {"texel_bytes", record.texelBytes},
                   {"codes_ms", record.codesMs}});
    return volume;
}

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

/// What programs ask of a figure.
Json judgement(const Figure& figure) {
    return {{"value", orNull(figure.value)},
            {"goal", orNull(figure.goal)},
            {"sense", name(figure.sense)},
            {"reached", orNull(figure.reached())}};
}

Json fieldsOf(const Figure& figure) {
    Json all = judgement(figure);
    all.update({{"key", figure.key},
                {"name", figure.name},
                {"volume", figure.volume},
                {"from", figure.from}});
    return all;
}

template <class T>
Json listOf(std::span<const T> items) {
    Json list = Json::list();
    for (const T& item : items) {
        list.push_back(fieldsOf(item));
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
    const StageDesc& stage = desc.stage;
    const OrbitCamera& camera = stage.camera;
    const Settings& s = stage.settings;
    return {{"size", Json::list({stage.size.x, stage.size.y})},
            {"camera", toJson(camera)},
            {"fov_degrees", stage.fovDegrees},
            {"layer_spacing_voxels", s.layerSpacingVoxels},
            {"lattice", name(s.lattice)},
            {"target", name(s.target)},
            {"space", name(s.space)},
            {"classification", name(s.classification)},
            {"termination", s.termination ? Json(*s.termination) : Json("off")},
            {"frames_per_row_at_most", desc.frames},
            {"partition_budget_bytes", stage.settings.skipOptions.memoryBudgetBytes},
            {"sizes", Json::listOf(desc.sizes)},
            {"quick", desc.quick}};
}

} // namespace

Report reportOf(const Desc& desc, const Measured& measured, const RunInfo& info,
                const gl::Caps& caps) {
    Json report = reportHeader(info, caps);
    report["conditions"] = conditionsOf(desc);
    report["volumes"] = listOf(measured.volumes);
    report["figures"] = listOf(measured.figures);
    report["summary"] = summaryOf(measured.figures);
    report["papers"] = publishedTables();
    report["rows"] = listOf(measured.rows);
    return {.json = report.dump(2) + "\n",
            .csv = csvOf(report["rows"], columnsOf({kColumns, kMeasuredColumns})),
            .line = lineOf(measured.figures)};
}

} // namespace slabcast::skipbench

#include "perf/skip/row_json.h"

#include "perf/report_json.h"

namespace slabcast::skipbench {

namespace {

constexpr const char* kCoverage = "speedup_coverage"; // of all ratios of a row

Json timesOf(const std::vector<double>& ms) {
    return slabcast::toJson(summarise(ms));
}

/// Structure and parameters: no others than the structure's own.
Json fieldsOf(const SkipOptions& o) {
    Json row{{"skip", name(o.structure)}};
    if (o.structure != SkipStructure::None) {
        row["skip_block"] = o.blockEdgeVoxels;
    }
    if (o.structure == SkipStructure::BitfieldOctree) {
        row["skip_bits"] = o.bits;
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
    Json row{{"frame_ms", timesOf(raced.samples)}, {"samples", Json::listOf(raced.samples)}};
    addRatio(row, "speedup", raced.speedup, kCoverage);
    return row;
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
    Json row{{"update_ms", timesOf(merge.ms)}};
    addRatio(row, "speedup", merge.speedup, kCoverage);
    addRatio(row, "speedup_of_ranges", merge.speedupOfRanges, kCoverage);
    return row;
}

} // namespace

const char* name(Table table) {
    constexpr const char* kNames[] = {"search",     "finals",     "frames",  "ratios", "work",
                                      "structures", "partitions", "rebuild", "merge",  "sizes"};
    return kNames[static_cast<int>(table)];
}

Json toJson(const Row& row) {
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
        all["search_ms"] = *row.leastMs;
    }
    if (row.counters) {
        all["counters"] = slabcast::toJson(*row.counters);
    }
    return all;
}

std::string idOf(const Row& row) {
    Json all = fieldsOf(row.options);
    all.update({{"table", name(row.table)}, {"volume", row.volume}});
    if (row.plan) {
        all.update(fieldsOf(*row.plan));
    }
    if (row.cube) {
        all["edge"] = row.cube->edge;
    }
    if (row.transfer) {
        all.update(fieldsOf(*row.transfer));
    }
    for (const auto& [key, word] : {std::pair{"family", row.family}, {"mode", row.mode}}) {
        if (word != nullptr) {
            all[key] = word;
        }
    }
    if (row.finalsOf) {
        all["finals_of"] = name(*row.finalsOf);
    }
    return all.dump();
}

Json keptOf(const Build& build) {
    return {{"ms", Json::listOf(build.ms)},         {"update_ms", Json::listOf(build.updateMs)},
            {"gpu_ms", Json::listOf(build.gpuMs)},  {"refused", build.refused},
            {"gpu_refused", build.gpuRefused},      {"gpu_bytes", build.memory.gpuBytes},
            {"host_bytes", build.memory.hostBytes}, {"occupied_fraction", build.occupiedFraction}};
}

Build buildOf(const Json& kept) {
    return {.ms = numbersOf(kept.at("ms")),
            .updateMs = numbersOf(kept.at("update_ms")),
            .gpuMs = numbersOf(kept.at("gpu_ms")),
            .refused = kept.at("refused").text(),
            .gpuRefused = kept.at("gpu_refused").text(),
            .memory = {kept.at("gpu_bytes").whole(), kept.at("host_bytes").whole()},
            .occupiedFraction = kept.at("occupied_fraction").number()};
}

std::vector<double> numbersOf(const Json& list) {
    std::vector<double> numbers;
    for (const Json& number : list) {
        numbers.push_back(number.number());
    }
    return numbers;
}

} // namespace slabcast::skipbench

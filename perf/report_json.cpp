#include "perf/report_json.h"

#include <algorithm>
#include <ctime>

#include "perf/stage.h"

namespace slabcast {

std::string keyOf(std::string_view words) {
    std::string key(words);
    std::replace_if(
        key.begin(), key.end(), [](char letter) { return letter == ' ' || letter == '-'; }, '_');
    return key;
}

Json toJson(const gl::Caps& caps) {
    Json device = {{"vendor", caps.vendor},
                   {"renderer", caps.renderer},
                   {"version", caps.driver},
                   {"software", caps.isSoftware}};
    if (!caps.assumed.empty()) {
        device["assumed"] = caps.assumed;
    }
    return device;
}

Json toJson(const VolumeInfo& info) {
    return {{"name", info.name},
            {"dims", Json::list({info.dims.x, info.dims.y, info.dims.z})},
            {"type", name(info.type)},
            {"unit", info.unit},
            {"spacing_mm", Json::list({info.spacingMm.x, info.spacingMm.y, info.spacingMm.z})},
            {"bytes", info.bytes}};
}

Json toJson(const OrbitCamera& camera) {
    return Json::list({camera.azimuthDegrees, camera.elevationDegrees, camera.distanceRadii});
}

Json toJson(const FramePlan& plan) {
    Json reasons = Json::list();
    for (const ReasonText& reason : explained(plan)) {
        reasons.push_back({{"what", reason.what}, {"why", reason.why}});
    }
    const bool terminates = plan.variant.terminates || plan.planesPerMark > 0;
    return {{"planes", plan.planes},
            {"layers_per_plane", plan.layersPerPlane},
            {"layers", plan.lattice.total},
            {"layer_spacing_mm", plan.lattice.spacingMm},
            {"lattice", name(plan.lattice.kind)},
            {"jitter", plan.lattice.jittered},
            {"variant", name(plan.variant)},
            {"tighten", plan.tighten},
            {"termination", terminates ? Json(plan.terminationAlpha) : Json("off")},
            {"order", name(plan.order)},
            {"planes_per_mark", plan.planesPerMark},
            {"target", name(plan.target)},
            {"space", name(plan.space)},
            {"draws_nothing", plan.drawsNothing},
            {"reasons", std::move(reasons)}};
}

Json toJson(const BuiltSkip& skip) {
    if (!skip.exists()) {
        return nullptr;
    }
    const SkipOptions& o = skip.options;
    Json parameters = {{"skip_block", o.blockEdgeVoxels}};
    const bool isBitfield = o.structure == SkipStructure::BitfieldOctree;
    const bool isPartitioned = o.structure == SkipStructure::Partitioned;
    if (isBitfield) {
        parameters["skip_bits"] = o.bits;
    }
    if (isPartitioned) {
        parameters["partitions"] = o.partitions;
    }
    if (isBitfield || isPartitioned) {
        parameters["separate_minimum"] = o.separateMinimum;
        parameters["value_range"] = o.valueRange ? Json::listOf(*o.valueRange) : Json();
    }
    if (isOctree(o.structure)) {
        parameters["initial_level"] = o.initialLevel;
        parameters["traversal"] = name(o.traversal);
    }
    return {{"structure", name(o.structure)},
            {"parameters", std::move(parameters)},
            {"builder", skip.onGpu ? "gpu" : "cpu"},
            {"build_ms", skip.buildMs},
            {"gpu_bytes", gpuBytes(skip)},
            {"host_bytes", hostBytes(skip)},
            {"occupied_fraction", skip.occupiedFraction}};
}

Json toJson(const FrameTimes& t) {
    if (t.count == 0) {
        return nullptr;
    }
    const bool enough = t.count >= kFewestForPercentiles;
    return {{"median", t.median},
            {"min", t.min},
            {"max", t.max},
            {"p10", enough ? Json(t.p10) : Json()},
            {"p90", enough ? Json(t.p90) : Json()},
            {"n", t.count}};
}

void addRatio(Json& row, const std::string& name, const PairedRatio& ratio,
              const std::string& coverage) {
    row[name] = ratio.median;
    row[name + "_low"] = ratio.interval.low;
    row[name + "_high"] = ratio.interval.high;
    row[coverage] = ratio.interval.coverage;
}

Json toJson(const Result<WorkCounters>& counters) {
    if (!counters) {
        return nullptr;
    }
    return {{"fragments", counters->fragments},
            {"layers_evaluated", counters->layersEvaluated},
            {"layers_skipped", counters->layersSkipped},
            {"volume_fetches", counters->volumeFetches},
            {"skip_fetches", counters->skipFetches},
            {"stretches", counters->stretches},
            {"blocks_visited", counters->blocksVisited}};
}

Json memoryOf(const Renderer& renderer, const RunInfo& run) {
    const GpuMemory gpu = renderer.gpuMemory();
    return {{"host_peak_bytes", run.peakHostBytes ? run.peakHostBytes() : 0},
            {"gpu_volume_bytes", gpu.volumeBytes},
            {"gpu_skip_bytes", gpu.skipBytes},
            {"gpu_other_bytes", gpu.otherBytes}};
}

Json reportHeader(const RunInfo& run, const gl::Caps& caps) {
    return {{"command", run.command},
            {"commit", run.commit},
            {"date", timestamp()},
            {"device", toJson(caps)}};
}

Json reportHeader(const RunInfo& run, const Stage& stage) {
    Json header = reportHeader(run, stage.caps());
    header["volume"] = toJson(stage.info());
    return header;
}

std::string timestamp() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

} // namespace slabcast

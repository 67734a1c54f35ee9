#include "platform/cli/skipbench_sizes.h"

#include <fmt/core.h>

#include "platform/cli/open_stage.h"
#include "platform/cli/skipbench_builds.h"
#include "platform/cli/skipbench_frames.h"

namespace slabcast {

namespace {

using nlohmann::json;

constexpr int kBuilds = 3;
constexpr double kRaceMs = 20e3;

/// Rows of frames, each with what the row of the same structure's builds says too; refused ones
/// have no frames.
json joined(json frames, const json& builds) {
    for (const json& build : builds) {
        bool found = false;
        for (json& frame : frames) {
            if (frame["structure"] == build["structure"]) {
                frame.update(build);
                found = true;
            }
        }
        if (!found) {
            frames.push_back(build);
        }
    }
    return frames;
}

Result<json> measureSize(SkipBench& bench, int edge) {
    json beginning = bench.row("sizes");
    beginning.update({{"edge", edge},
                      {"volumeBytes", bench.stage.info().bytes},
                      {"mode", kMarchingOnly.name},
                      {"family", "ray casting"}});
    const std::vector<SkipOptions> structures = usualStructures(bench.options);
    json builds;
    {
        const Workshop workshop(bench.stage);
        beginning["codesMs"] = workshop.codesMs();
        Result<json> built = buildRows(workshop, workshop.visibilityUnder(bench.stage.scene()),
                                       structures, kBuilds, beginning);
        if (!built) {
            return tl::unexpected(built.error());
        }
        builds = std::move(*built);
    }
    std::vector<Refusal> refused; // named with the builds
    return subjectsOf(bench.stage, structures, refused)
        .and_then([&](const std::vector<Subject>& subjects) {
            return raceRays(bench, subjects, kMarchingOnly, beginning, kFewestFrames, kRaceMs);
        })
        .map([&](json frames) { return joined(std::move(frames), builds); });
}

} // namespace

Result<json> measureSizes(const SkipbenchOptions& options, const SceneOptions& volume,
                          const std::string& label, Progress& progress) {
    json rows = json::array();
    for (const int edge : options.sizes) {
        progress.show(fmt::format("{}: resampled to {}^3", label, edge));
        SceneOptions resampled = volume;
        resampled.input.cubeEdge = edge;
        Result<OpenStage> opened = openStage(resampled);
        if (!opened) {
            return tl::unexpected(opened.error());
        }
        Stage* const stage = &opened->stage;
        SkipBench bench{*stage, options, label, progress};
        const Result<json> measured = measureSize(bench, edge);
        if (!measured) {
            return measured;
        }
        rows.insert(rows.end(), measured->begin(), measured->end());
    }
    return rows;
}

} // namespace slabcast

#include "perf/skip/sizes.h"

#include <algorithm>

#include "perf/skip/builds.h"
#include "perf/skip/frames.h"

namespace slabcast::skipbench {

namespace {

constexpr int kBuilds = 3;
constexpr double kRaceMs = 20e3;

/// Rows of frames, each with what the row of the same structure's builds says too; refused ones
/// have no frames.
std::vector<Row> joined(std::vector<Row> frames, std::vector<Row> builds) {
    for (Row& build : builds) {
        const auto frame = std::find_if(frames.begin(), frames.end(), [&](const Row& row) {
            return row.options.structure == build.options.structure;
        });
        if (frame != frames.end()) {
            frame->build = std::move(build.build);
        } else {
            frames.push_back(std::move(build));
        }
    }
    return frames;
}

Result<std::vector<Row>> measureSize(Bench& bench, int edge) {
    Row beginning = bench.row(Table::Sizes, {});
    beginning.mode = kMarchingOnly.name;
    beginning.family = kRayCasting;
    beginning.cube = {edge, bench.stage.info().bytes, 0.0};
    const std::vector<SkipOptions> structures = usualStructures(bench.desc);
    std::vector<Row> builds;
    {
        const Workshop workshop(bench.stage);
        beginning.cube->codesMs = workshop.codesMs();
        Result<std::vector<Row>> built =
            buildRows(workshop, workshop.visibilityUnder(bench.stage.scene()), structures, kBuilds,
                      beginning, bench.store);
        if (!built) {
            return built;
        }
        builds = std::move(*built);
    }
    return subjectsOf(bench.stage, structures)
        .and_then([&](const std::vector<Subject>& subjects) {
            return raceRays(bench, subjects, kMarchingOnly, beginning, kFewestFrames, kRaceMs);
        })
        .map([&](std::vector<Row> frames) { return joined(std::move(frames), std::move(builds)); });
}

} // namespace

Result<std::vector<Row>> measureSizes(const Desc& desc, const StageDesc& opened, const Host& host,
                                      const VolumeRecord& volume, ProgressLine& progress,
                                      RunStore& store) {
    std::vector<Row> rows;
    for (const int edge : desc.sizes) {
        progress.show(volume.name + ": resampled to " + std::to_string(edge) + "^3");
        Result<Stage> stage = host.open(volume.input, edge, opened);
        if (!stage) {
            return tl::unexpected(stage.error());
        }
        Bench bench{*stage, desc, volume.name, progress, store, std::move(rows)};
        Result<std::vector<Row>> measured = measureSize(bench, edge);
        if (!measured) {
            return measured;
        }
        bench.add(std::move(*measured));
        rows = std::move(bench.rows);
    }
    return rows;
}

} // namespace slabcast::skipbench

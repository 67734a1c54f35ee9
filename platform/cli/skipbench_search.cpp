#include "platform/cli/skipbench_search.h"

#include <algorithm>

#include <fmt/core.h>

#include "platform/cli/skipbench_race.h"

namespace slabcast {

namespace {

using nlohmann::json;

constexpr std::size_t kFinalists = 5; // of a structure
constexpr double kFinalsMs = 20e3;

struct Tried {
    SkipOptions options;
    double ms = 0.0;
};

/// The fastest few of one structure, on the picture as it is.
Result<std::vector<Tried>> triedOf(SkipBench& bench, SkipStructure structure) {
    const std::vector<SkipOptions> grid =
        searchGrid(structure, bench.stage.info().dims, bench.options.quick);
    std::vector<Tried> tried;
    for (const SkipOptions& options : grid) {
        bench.progress.show(fmt::format("{}: searching {} {} of {}", bench.volume, name(structure),
                                        tried.size() + 1, grid.size()));
        const Result<Scene> scene = bench.stage.variation(bench.stage.scene().look().tf, options);
        if (!scene) {
            return tl::unexpected(scene.error());
        }
        const Result<double> ms =
            entrantOf(bench.stage, *scene, rayCasting(bench.options, kMarchingOnly), json::object())
                .and_then([&](const Entrant& entrant) { return leastMs(bench.stage, entrant); });
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        tried.push_back({options, *ms});
        json row = bench.row("search");
        row.update(toJson(options));
        row["ms"] = *ms;
        bench.rows.push_back(std::move(row));
    }
    std::stable_sort(tried.begin(), tried.end(),
                     [](const Tried& a, const Tried& b) { return a.ms < b.ms; });
    tried.resize(std::min(tried.size(), kFinalists));
    return tried;
}

/// The fastest of the finalists, racing at full size; none, which they are measured by, races too.
Result<SkipOptions> winnerOf(SkipBench& bench, const std::vector<Tried>& finalists,
                             const BenchMode& mode) {
    if (finalists.size() == 1) {
        return finalists.front().options;
    }
    std::vector<SkipOptions> structures{{.structure = SkipStructure::None}};
    for (const Tried& tried : finalists) {
        structures.push_back(tried.options);
    }
    json row = bench.row("finals");
    row.update({{"finalsOf", name(finalists.front().options.structure)}, {"mode", mode.name}});
    std::vector<Refusal> refused; // none: they were built before
    const Result<json> rows =
        subjectsOf(bench.stage, structures, refused)
            .and_then([&](const std::vector<Subject>& subjects) {
                return raceRays(bench, subjects, mode, row, bench.options.frames, kFinalsMs);
            });
    if (!rows) {
        return tl::unexpected(rows.error());
    }
    bench.rows.insert(bench.rows.end(), rows->begin(), rows->end());
    const auto best =
        std::max_element(rows->begin() + 1, rows->end(), [](const json& a, const json& b) {
            return a["speedup"].get<double>() < b["speedup"].get<double>();
        });
    return structures[static_cast<std::size_t>(best - rows->begin())];
}

} // namespace

Result<BestParameters> searchParameters(SkipBench& bench) {
    BestParameters best;
    for (const SkipOptions& usual : usualStructures(bench.options)) {
        if (usual.structure == SkipStructure::None ||
            usual.structure == SkipStructure::Partitioned) {
            best.marching.push_back(usual);
            best.terminating.push_back(usual);
            continue;
        }
        const glm::ivec2 size = bench.options.size;
        bench.stage.resize(smaller(size));
        const Result<std::vector<Tried>> finalists = triedOf(bench, usual.structure);
        bench.stage.resize(size);
        if (!finalists) {
            return tl::unexpected(finalists.error());
        }
        for (const auto& [winners, mode] :
             {std::pair{&best.marching, kMarchingOnly}, std::pair{&best.terminating, kEarlyExit}}) {
            const Result<SkipOptions> winner = winnerOf(bench, *finalists, mode);
            if (!winner) {
                return tl::unexpected(winner.error());
            }
            winners->push_back(*winner);
        }
    }
    return best;
}

} // namespace slabcast

#include "perf/skip/search.h"

#include <algorithm>

#include "perf/skip/race.h"
#include "perf/skip/row_json.h"
#include "perf/skip/search_grid.h"

namespace slabcast::skipbench {

namespace {

constexpr std::size_t kFinalists = 5; // of a structure
constexpr double kFinalsMs = 20e3;

struct Tried {
    SkipOptions options;
    double ms = 0.0;
};

/// A few frames of ray casting; a structure that was tried already is not built again.
Result<double> triedMs(Bench& bench, const SkipOptions& options) {
    const Row row = bench.row(Table::Search, options);
    return bench.timed(idOf(row), [&]() -> Result<double> {
        const Result<Scene> scene = bench.stage.variation(bench.stage.scene().look().tf, options);
        if (!scene) {
            return tl::unexpected(scene.error());
        }
        return entrantOf(bench.stage, *scene, rayCasting(bench.desc, kMarchingOnly), row)
            .and_then([&](const Entrant& entrant) { return leastMs(bench.stage, entrant); });
    });
}

/// The fastest few of one structure, on the picture as it is.
Result<std::vector<Tried>> triedOf(Bench& bench, SkipStructure structure) {
    const std::vector<SkipOptions> grid =
        searchGrid(structure, bench.stage.info().dims, bench.desc.quick);
    std::vector<Tried> tried;
    for (const SkipOptions& options : grid) {
        bench.show(std::string("searching ") + name(structure) + " " +
                   std::to_string(tried.size() + 1) + " of " + std::to_string(grid.size()));
        const Result<double> ms = triedMs(bench, options);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        tried.push_back({options, *ms});
        bench.rows.push_back(bench.row(Table::Search, options));
        bench.rows.back().leastMs = *ms;
    }
    std::stable_sort(tried.begin(), tried.end(),
                     [](const Tried& a, const Tried& b) { return a.ms < b.ms; });
    tried.resize(std::min(tried.size(), kFinalists));
    return tried;
}

/// The fastest of the finalists, racing at full size; none, which they are measured by, races too.
Result<SkipOptions> winnerOf(Bench& bench, const std::vector<Tried>& finalists, const Mode& mode) {
    if (finalists.size() == 1) {
        return finalists.front().options;
    }
    std::vector<SkipOptions> structures{{.structure = SkipStructure::None}};
    for (const Tried& tried : finalists) {
        structures.push_back(tried.options);
    }
    Row beginning = bench.row(Table::Finals, {});
    beginning.finalsOf = finalists.front().options.structure;
    beginning.mode = mode.name;
    Result<std::vector<Row>> rows =
        subjectsOf(bench.stage, structures).and_then([&](const std::vector<Subject>& subjects) {
            return raceRays(bench, subjects, mode, beginning, bench.desc.frames, kFinalsMs);
        });
    if (!rows) {
        return tl::unexpected(rows.error());
    }
    const auto best =
        std::max_element(rows->begin() + 1, rows->end(), [](const Row& a, const Row& b) {
            return a.raced->speedup.median < b.raced->speedup.median;
        });
    const SkipOptions winner = best->options;
    bench.add(std::move(*rows));
    return winner;
}

} // namespace

Result<BestParameters> searchParameters(Bench& bench) {
    BestParameters best;
    for (const SkipOptions& usual : usualStructures(bench.desc)) {
        if (usual.structure == SkipStructure::None ||
            usual.structure == SkipStructure::Partitioned) {
            best.marching.push_back(usual);
            best.terminating.push_back(usual);
            continue;
        }
        const glm::ivec2 size = bench.desc.stage.size;
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

} // namespace slabcast::skipbench

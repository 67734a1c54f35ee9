#include "perf/skip/race.h"

#include <algorithm>

#include "perf/error/scene_key.h"
#include "perf/race.h"
#include "perf/run_store.h"
#include "perf/skip/row_json.h"
#include "perf/skip/subject.h"

namespace slabcast::skipbench {

namespace {

constexpr int kFramesOfLeast = 3;

Racer racerOf(const Entrant& entrant) {
    return {entrant.scene, &*entrant.row.plan};
}

/// By what all entrants are.
std::string idOf(const std::vector<Entrant>& entrants, int rounds) {
    std::string all;
    for (const Entrant& entrant : entrants) {
        all += skipbench::idOf(entrant.row) + "\n";
    }
    const Row& first = entrants.front().row;
    return first.volume + "/" + name(first.table) + "/" + std::to_string(rounds) + "/" +
           fingerprint(std::as_bytes(std::span(all)));
}

} // namespace

Result<Entrant> entrantOf(const Stage& stage, const Scene& scene, const Settings& settings,
                          Row row) {
    Settings own = settings;
    own.skip = settings.skip.value_or(scene.skip().options.structure);
    return plan(scene.facts(), own, stage.caps(), {}).map([&](FramePlan plan) {
        row.plan = std::move(plan);
        return Entrant{&scene, std::move(row)};
    });
}

Result<double> leastMs(Stage& stage, const Entrant& entrant) {
    Result<double> least = timedFrame(stage, racerOf(entrant), 0.0);
    for (int k = 1; least && k < kFramesOfLeast; ++k) {
        least = stage.drawTimed(*entrant.row.plan, 0.0).map([&](double ms) {
            return std::min(ms, *least);
        });
    }
    return least;
}

Result<std::vector<Row>> race(Bench& bench, const std::vector<Entrant>& entrants, int rounds,
                              double budgetMs) {
    Stage& stage = bench.stage;
    std::vector<Racer> racers;
    std::transform(entrants.begin(), entrants.end(), std::back_inserter(racers), racerOf);
    const Result<Laps> laps = slabcast::race(
        stage, racers, {.id = idOf(entrants, rounds), .rounds = rounds, .budgetMs = budgetMs},
        bench.store);
    if (!laps) {
        return tl::unexpected(laps.error());
    }
    std::vector<Row> rows;
    for (std::size_t k = 0; k < entrants.size(); ++k) {
        stage.show(*entrants[k].scene);
        Row row = entrants[k].row;
        if (Result<void> ready = stage.prepare(*row.plan); !ready) {
            return tl::unexpected(ready.error());
        }
        row.raced = Raced{(*laps)[k], pairedRatio(laps->front(), (*laps)[k])};
        row.counters = stage.countWork(*row.plan);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace slabcast::skipbench

#include "perf/skip/race.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "perf/skip/bench.h"
#include "perf/skip/paired_ratio.h"

namespace slabcast::skipbench {

namespace {

constexpr int kFramesOfLeast = 3;

using Samples = std::vector<std::vector<double>>; // of each entrant, round by round

/// The time of one frame after one that is not counted, ms.
Result<double> timedFrame(Stage& stage, const Entrant& entrant, double turnDegrees) {
    stage.show(*entrant.scene);
    if (Result<void> ready = stage.prepare(*entrant.row.plan); !ready) {
        return tl::unexpected(ready.error());
    }
    if (Result<double> first = stage.drawTimed(*entrant.row.plan, turnDegrees); !first) {
        return first;
    }
    return stage.drawTimed(*entrant.row.plan, turnDegrees);
}

/// What fits into the time, but neither too few nor more than asked for.
int roundsWithin(double budgetMs, double roundMs, int most) {
    return std::clamp(static_cast<int>(budgetMs / std::max(roundMs, 1e-3)), kFewestFrames,
                      std::max(most, kFewestFrames));
}

/// Compiles and uploads for the first time; what a round takes from then on.
Result<double> warmUp(Stage& stage, const std::vector<Entrant>& entrants) {
    double roundMs = 0.0;
    for (const Entrant& entrant : entrants) {
        const Result<double> ms = timedFrame(stage, entrant, 0.0);
        if (!ms) {
            return ms;
        }
        roundMs += 2.0 * *ms;
    }
    return roundMs;
}

Result<Samples> samplesOf(Stage& stage, const std::vector<Entrant>& entrants, int rounds) {
    Samples samples(entrants.size());
    std::vector<std::size_t> order(entrants.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 random(1); // the same shuffles in every run
    for (int round = 0; round < rounds; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        for (const std::size_t k : order) {
            const Result<double> ms = timedFrame(stage, entrants[k], 360.0 * round / rounds);
            if (!ms) {
                return tl::unexpected(ms.error());
            }
            samples[k].push_back(*ms);
        }
    }
    return samples;
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
    Result<double> least = timedFrame(stage, entrant, 0.0);
    for (int k = 1; least && k < kFramesOfLeast; ++k) {
        least = stage.drawTimed(*entrant.row.plan, 0.0).map([&](double ms) {
            return std::min(ms, *least);
        });
    }
    return least;
}

Result<std::vector<Row>> race(Stage& stage, const std::vector<Entrant>& entrants, int rounds,
                              double budgetMs) {
    const Result<double> roundMs = warmUp(stage, entrants);
    if (!roundMs) {
        return tl::unexpected(roundMs.error());
    }
    const Result<Samples> samples =
        samplesOf(stage, entrants, roundsWithin(budgetMs, *roundMs, rounds));
    if (!samples) {
        return tl::unexpected(samples.error());
    }
    std::vector<Row> rows;
    for (std::size_t k = 0; k < entrants.size(); ++k) {
        stage.show(*entrants[k].scene);
        Row row = entrants[k].row;
        if (Result<void> ready = stage.prepare(*row.plan); !ready) {
            return tl::unexpected(ready.error());
        }
        row.raced = Raced{(*samples)[k], pairedRatio(samples->front(), (*samples)[k])};
        row.counters = stage.countWork(*row.plan);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace slabcast::skipbench

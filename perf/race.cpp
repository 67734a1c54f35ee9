#include "perf/race.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>

#include "perf/frame_times.h"
#include "perf/run_store.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

/// What fits into the time, but neither too few nor more than asked for.
int roundsWithin(double budgetMs, double roundMs, int most) {
    return std::clamp(static_cast<int>(budgetMs / std::max(roundMs, 1e-3)),
                      std::min(kFewestFrames, most), most);
}

/// Compiles and uploads for the first time; what a round takes from then on.
Result<double> warmUp(Stage& stage, std::span<const Racer> racers) {
    double roundMs = 0.0;
    for (const Racer& racer : racers) {
        const Result<double> ms = timedFrame(stage, racer, 0.0);
        if (!ms) {
            return ms;
        }
        roundMs += 2.0 * *ms;
    }
    return roundMs;
}

std::vector<std::size_t> orderOf(int round, std::size_t racers) {
    std::vector<std::size_t> order(racers);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 random(static_cast<std::uint32_t>(round) + 1);
    std::shuffle(order.begin(), order.end(), random);
    return order;
}

/// A race under way. Borrows all.
class Race {
public:
    Race(Stage& stage, std::span<const Racer> racers, const RaceDesc& desc, RunStore& store)
        : stage_(stage), racers_(racers), desc_(desc), store_(store) {}

    Result<Laps> run() {
        const Result<int> rounds = roundsToRun();
        if (!rounds) {
            return tl::unexpected(rounds.error());
        }
        Laps laps(racers_.size());
        for (int round = 0; round < *rounds; ++round) {
            const Result<std::vector<double>> ms = roundOf(round, *rounds);
            if (!ms) {
                return tl::unexpected(ms.error());
            }
            for (std::size_t k = 0; k < laps.size(); ++k) {
                laps[k].push_back((*ms)[k]);
            }
        }
        return laps;
    }

private:
    std::string idOf(int round) const { return desc_.id + "/round " + std::to_string(round); }

    /// As an earlier run decided, or by what a round takes.
    Result<int> roundsToRun() {
        const Json* kept = store_.find(desc_.id);
        if (kept != nullptr && kept->at("rounds").whole() >= 1) {
            return static_cast<int>(
                std::min<std::int64_t>(kept->at("rounds").whole(), desc_.rounds));
        }
        const Result<double> roundMs = warm();
        if (!roundMs) {
            return tl::unexpected(roundMs.error());
        }
        const int rounds = desc_.budgetMs > 0.0
                               ? roundsWithin(desc_.budgetMs, *roundMs, desc_.rounds)
                               : desc_.rounds;
        return store_.add({{"id", desc_.id}, {"rounds", rounds}}).map([=] { return rounds; });
    }

    /// Nothing where it is not finished, or no round of this race.
    std::optional<std::vector<double>> keptRound(int round) const {
        const Json* kept = store_.find(idOf(round));
        if (kept == nullptr || kept->at("ms").size() != racers_.size()) {
            return std::nullopt;
        }
        std::vector<double> ms;
        for (const Json& one : kept->at("ms")) {
            ms.push_back(one.number());
        }
        const bool sound = std::all_of(ms.begin(), ms.end(), [](double one) { return one > 0.0; });
        return sound ? std::optional(std::move(ms)) : std::nullopt;
    }

    Result<double> warm() {
        isWarm_ = true;
        return warmUp(stage_, racers_);
    }

    Result<std::vector<double>> roundOf(int round, int rounds) {
        if (std::optional<std::vector<double>> kept = keptRound(round)) {
            return std::move(*kept);
        }
        if (!isWarm_) {
            if (const Result<double> warmed = warm(); !warmed) {
                return tl::unexpected(warmed.error());
            }
        }
        if (desc_.show) {
            desc_.show(round, rounds);
        }
        std::vector<double> ms(racers_.size());
        for (const std::size_t k : orderOf(round, racers_.size())) {
            const Result<double> one = timedFrame(stage_, racers_[k], 360.0 * round / rounds);
            if (!one) {
                return tl::unexpected(one.error());
            }
            ms[k] = *one;
        }
        return store_.add({{"id", idOf(round)}, {"ms", Json::listOf(ms)}}).map([&] {
            return std::move(ms);
        });
    }

    Stage& stage_;
    std::span<const Racer> racers_;
    const RaceDesc& desc_;
    RunStore& store_;
    bool isWarm_ = false;
};

} // namespace

Result<double> timedFrame(Stage& stage, const Racer& racer, double turnDegrees) {
    if (racer.scene != nullptr) {
        stage.show(*racer.scene);
    }
    if (Result<void> ready = stage.prepare(*racer.plan); !ready) {
        return tl::unexpected(ready.error());
    }
    if (Result<double> first = stage.drawTimed(*racer.plan, turnDegrees); !first) {
        return first;
    }
    return stage.drawTimed(*racer.plan, turnDegrees);
}

Result<Laps> race(Stage& stage, std::span<const Racer> racers, const RaceDesc& desc,
                  RunStore& store) {
    SLABCAST_EXPECTS(!racers.empty(), racers.size());
    SLABCAST_EXPECTS(desc.rounds >= 1, desc.rounds);
    return Race(stage, racers, desc, store).run();
}

} // namespace slabcast

#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/options.h"

namespace slabcast {

/// One way to draw what others draw too.
struct Entrant {
    const Scene* scene = nullptr; // a variation of the stage's, with its structure
    FramePlan plan;
    nlohmann::json row; // what it is
};

/// Contract: a structure of its settings is the scene's, or none.
Result<Entrant> entrantOf(const Stage& stage, const Scene& scene, const Settings& settings,
                          nlohmann::json row);

/// One of each item, as `enter` makes it.
template <class Items, class Enter>
Result<std::vector<Entrant>> entrantsOf(const Items& items, Enter enter) {
    std::vector<Entrant> entrants;
    for (const auto& item : items) {
        Result<Entrant> entrant = enter(item);
        if (!entrant) {
            return tl::unexpected(entrant.error());
        }
        entrants.push_back(std::move(*entrant));
    }
    return entrants;
}

/// The least of a few frames, after one that is not counted: what disturbs a frame only ever makes
/// it longer. For choices among many, before a race decides between few.
Result<double> leastMs(Stage& stage, const Entrant& entrant);

/// All entrants on equal terms: in every round each draws one frame of the same view, after one
/// that is not counted, in an order that is shuffled anew, so that the drift of a busy machine hits
/// all alike; the views of the rounds go once around. At most `rounds`, fewer where they would take
/// over `budgetMs`, 3 at least. Gives the rows with `frameMs`, the `samples` of the rounds,
/// `speedup` (how many times as fast as the first entrant: the median over the rounds, each with
/// itself) and `counters`, of the first view.
Result<nlohmann::json> race(Stage& stage, const std::vector<Entrant>& entrants, int rounds,
                            double budgetMs);

/// Median of a[k] / b[k]: drift, and views that take longer, are the same in both.
double pairedRatio(const std::vector<double>& a, const std::vector<double>& b);

} // namespace slabcast

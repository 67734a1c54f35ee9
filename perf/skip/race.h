#pragma once

#include <vector>

#include "perf/skip/row.h"

namespace slabcast {
class Scene;
class Stage;
} // namespace slabcast

namespace slabcast::skipbench {

struct Bench;

/// One way to draw what others draw too.
struct Entrant {
    const Scene* scene = nullptr; // a variation of the stage's, with its structure
    Row row;                      // what it is, with the plan that it draws by
};

/// Contract: a structure of its settings is the scene's, or none. Fails: as plan().
Result<Entrant> entrantOf(const Stage& stage, const Scene& scene, const Settings& settings,
                          Row row);

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

/// A race (perf/race.h) of all entrants in at most `rounds`, and as many as fit into `budgetMs`.
/// Gives the rows with their part of it (how many times as fast as the first) and the counters of
/// the first view.
Result<std::vector<Row>> race(Bench& bench, const std::vector<Entrant>& entrants, int rounds,
                              double budgetMs);

} // namespace slabcast::skipbench

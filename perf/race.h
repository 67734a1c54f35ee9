#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace slabcast {

class RunStore;
class Scene;
class Stage;
struct FramePlan;

/// One way to draw what others draw too.
struct Racer {
    const Scene* scene = nullptr; // a variation of the stage's, with its structure; null: the
                                  // stage's as it is, for all or for none of a race
    const FramePlan* plan = nullptr;
};

struct RaceDesc {
    std::string id;        // names the race in the store
    int rounds = 9;        // at most
    double budgetMs = 0.0; // rounds beyond this are left out; 0: as many as asked for
    std::function<void(int round, int rounds)> show{}; // before each; may be empty
};

/// ms, of each racer, round by round.
using Laps = std::vector<std::vector<double>>;

/// Makes all that a racer needs, and draws once what is not counted: then one frame, ms.
Result<double> timedFrame(Stage& stage, const Racer& racer, double turnDegrees);

/// All on equal terms: in every round each draws one frame of the same view, after one that is not
/// counted, in an order that is shuffled anew, so that the drift of a busy machine hits all alike;
/// the views of the rounds go once around. Fewer rounds than asked for where they would take over
/// the budget, kFewestFrames at least. Programs of all stay; textures that others need not are let
/// go and made again between racers, so that the race takes the memory of its greatest racer.
/// Finished rounds are kept in the store, and found there by a run that goes on: the order and the
/// view of a round depend on its number alone. Fails: as the stage and the store. Contract: one
/// racer at least. Tested by: skipbench_test.py, cli_reports_test.py
Result<Laps> race(Stage& stage, std::span<const Racer> racers, const RaceDesc& desc,
                  RunStore& store);

} // namespace slabcast

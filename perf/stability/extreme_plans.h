#pragma once

#include "perf/stability/bench.h"

namespace slabcast::stability {

/// The scenes that extreme plans draw: 24 voxels of 1 mm along each edge.
struct PlanScenes {
    Scene ball;    // two colours, faint at its rim, nothing around it
    Scene dense;   // the same, opaque inside
    Scene uniform; // one material
};
/// Both balls with the skip structure.
Result<PlanScenes> planScenes(Bench& bench);
/// From 2.5 radii away, turned about two axes: all rays meet the sphere at an angle of their own.
View planView(const Scene& scene, glm::ivec2 size);

/// Parts of the extreme-plans family.
void planRatioCases(Bench& bench, const PlanScenes& scenes);
void planFormCases(Bench& bench, const PlanScenes& scenes);
void planTerminationCases(Bench& bench, const PlanScenes& scenes);

} // namespace slabcast::stability

#include "core/plan/decisions/decision.h"

namespace slabcast {

Result<void> decideOutlines(const PlanInput& in, FramePlan& plan) {
    plan.tighten = in.settings.tighten && in.facts.skip.structure != SkipStructure::None;
    because(plan, plan.tighten ? ReasonId::TightPlanes : ReasonId::SphereOutlines);
    return {};
}

} // namespace slabcast

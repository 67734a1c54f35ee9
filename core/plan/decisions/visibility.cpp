#include "core/plan/decisions/decision.h"

namespace slabcast {

Result<void> decideVisibility(const PlanInput& in, FramePlan& plan) {
    plan.drawsNothing = !in.facts.anythingVisible;
    if (plan.drawsNothing) {
        because(plan, ReasonId::DrawsNothing);
    }
    return {};
}

} // namespace slabcast

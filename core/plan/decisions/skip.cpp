#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

/// The structure that was built, or none: asked for, or where it would not pay.
ReasonId chosen(const PlanInput& in, const FramePlan& plan) {
    const auto& [facts, settings, caps, measurements] = in;
    if (facts.skip.structure == SkipStructure::None) {
        return ReasonId::SkipNotBuilt;
    }
    if (settings.skip) {
        return settings.skip == SkipStructure::None ? ReasonId::SkipNoneAsked : ReasonId::SkipAsked;
    }
    if (facts.occupiedFraction > kWorthSkipping) {
        return ReasonId::SkipNothingEmpty;
    }
    const bool thin = plan.layersPerPlane < kFewestLayersToSkip && !facts.exactField;
    return thin ? ReasonId::SkipThinPlanes : ReasonId::SkipChosen;
}

} // namespace

Result<void> decideSkip(const PlanInput& in, FramePlan& plan) {
    const auto& [facts, settings, caps, measurements] = in;
    const ReasonId reason = chosen(in, plan);
    if (reason == ReasonId::SkipAsked || reason == ReasonId::SkipChosen) {
        plan.skip = facts.skip.structure;
        plan.variant.skip = formOf(facts.skip);
    }
    const LooksCost cost = facts.exactField  ? LooksCost::SpareEightFetches
                           : caps.isSoftware ? LooksCost::AsMeasuredHere
                                             : LooksCost::AsMeasuredElsewhere;
    because(plan, reason,
            {double(facts.skip.structure), 100.0 * facts.occupiedFraction,
             double(facts.skip.blockEdgeVoxels),
             reason == ReasonId::SkipNothingEmpty ? 100.0 * kWorthSkipping
                                                  : double(plan.layersPerPlane),
             double(cost)});
    return {};
}

} // namespace slabcast

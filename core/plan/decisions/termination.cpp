#include <cmath>

#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

ReasonId chosen(const PlanInput& in, const FramePlan& plan) {
    if (!terminationOf(in, plan)) {
        return ReasonId::TerminationNotAsked;
    }
    if (plan.variant.fetchesTarget) {
        return ReasonId::TerminationAcross;
    }
    if (plan.layersPerPlane == 1) {
        return ReasonId::TerminationOfOneLayer;
    }
    const double depth = mostDepthOf(in, plan, plan.layersPerPlane);
    return 1.0 - std::exp(-depth) < *terminationOf(in, plan) ? ReasonId::TerminationTooThin
                                                             : ReasonId::TerminationOfSegments;
}

} // namespace

double straightDepthOf(const PlanInput& in, const FramePlan& plan, double layers) {
    return in.facts.maxExtinctionPerMm * plan.lattice.spacingMm * layers;
}

double mostDepthOf(const PlanInput& in, const FramePlan& plan, double layers) {
    return straightDepthOf(in, plan, layers) * 2.0;
}

Result<void> decideTermination(const PlanInput& in, FramePlan& plan) {
    const ReasonId reason = chosen(in, plan);
    because(plan, reason, {terminationOf(in, plan).value_or(1.0)});
    if (reason == ReasonId::TerminationOfSegments) {
        plan.variant.terminates = true;
        plan.terminationAlpha = *terminationOf(in, plan);
    }
    return {};
}

} // namespace slabcast

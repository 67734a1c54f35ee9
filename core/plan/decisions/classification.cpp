#include "core/plan/decisions/decision.h"
#include "core/transfer/preintegrated.h"

namespace slabcast {

namespace {

ReasonId reasonOf(const Settings& settings) {
    const bool post = settings.classification == Classification::Post;
    return settings.classification == Classification::Preintegrated
               ? ReasonId::ClassificationOfIntervals
           : !settings.shaded ? ReasonId::ClassificationUnlit
           : post             ? ReasonId::ClassificationLit
                              : ReasonId::ClassificationBaked;
}

} // namespace

Result<void> decideClassification(const PlanInput& in, FramePlan& plan) {
    const auto& [facts, settings, caps, measurements] = in;
    const Classification way = settings.classification;
    plan.variant.classification = way;
    plan.variant.exactField = facts.exactField && way != Classification::Pre;
    plan.variant.shaded = settings.shaded && way == Classification::Post;
    const double colourError =
        facts.visibleColorRange * preintegratedColorError(mostDepthOf(in, plan, 1));
    because(plan, reasonOf(settings), {double(way), colourError});
    if (facts.wideTable && way == Classification::Preintegrated) {
        because(plan, ReasonId::WideTableWarning);
    }
    if (facts.oneMaterial) {
        because(plan, ReasonId::OneMaterial);
    }
    if (plan.variant.exactField) {
        because(plan, ReasonId::ExactField);
    }
    return {};
}

} // namespace slabcast

#include "core/plan/decisions/decision.h"
#include "core/transfer/preintegrated.h"

namespace slabcast {

namespace {

ReasonId reasonOf(const Settings& settings) {
    const bool post = settings.classification == Classification::Post;
    return settings.classification == Classification::Preintegrated
               ? ReasonId::ClassificationOfIntervals
           : !settings.shaded                           ? ReasonId::ClassificationUnlit
           : post && settings.normals == Normals::Baked ? ReasonId::ClassificationLitByNormals
           : post                                       ? ReasonId::ClassificationLit
                                                        : ReasonId::ClassificationBaked;
}

/// Where a layer's opacity is made. Texels are taken as they are where they were made for layers of
/// this length.
Lengths lengthsOf(const PlanInput& in, const FramePlan& plan) {
    if (plan.lattice.kind != LatticeKind::Shells || plan.variant.exactField ||
        in.settings.classification == Classification::Preintegrated) {
        return Lengths::PerRay;
    }
    if (in.settings.classification == Classification::Post) {
        return in.facts.wideTable ? Lengths::PerRay : Lengths::Baked;
    }
    const bool alike = in.facts.classifiedLengthMm == plan.lattice.spacingMm;
    return alike ? Lengths::Baked : Lengths::PerRay;
}

void chooseLengths(const PlanInput& in, FramePlan& plan) {
    plan.variant.lengths = lengthsOf(in, plan);
    const bool baked = plan.variant.lengths == Lengths::Baked;
    because(plan, baked ? ReasonId::LengthsBaked : ReasonId::LengthsPerRay);
    if (in.settings.classification != Classification::Post) {
        return;
    }
    const bool filters = in.facts.filtersTable && !plan.variant.exactField;
    plan.variant.table = filters ? TableRead::Filtered : TableRead::Exact;
    because(plan, filters ? ReasonId::TableFiltered : ReasonId::TableFetched);
}

} // namespace

Result<void> decideClassification(const PlanInput& in, FramePlan& plan) {
    const auto& [facts, settings, caps, measurements] = in;
    const Classification way = settings.classification;
    plan.variant.classification = way;
    plan.variant.exactField = facts.exactField && way != Classification::Pre;
    plan.variant.shaded = settings.shaded && way == Classification::Post;
    plan.variant.normals = plan.variant.shaded ? settings.normals : Normals::Computed;
    const double colourError =
        facts.visibleColorRange * preintegratedColorError(mostDepthOf(in, plan, 1));
    because(
        plan, reasonOf(settings),
        {double(way), colourError, facts.normals.meanDegrees, facts.normals.percentile95Degrees});
    if (facts.wideTable && way == Classification::Preintegrated) {
        because(plan, ReasonId::WideTableWarning);
    }
    chooseLengths(in, plan);
    if (facts.oneMaterial) {
        because(plan, ReasonId::OneMaterial);
    }
    if (plan.variant.exactField) {
        because(plan, ReasonId::ExactField);
    }
    return {};
}

} // namespace slabcast

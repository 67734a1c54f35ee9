#include "core/plan/decisions/decision.h"
#include "core/plan/shader_axes.h"

namespace slabcast {

namespace {

/// Whether planes end where their segments' text does: one that went on would draw the next one's.
/// A loop's groups begin where a leap ends, and so end anywhere.
bool textEndsWithPlane(const FramePlan& plan) {
    const int unrolled = plan.variant.unroll;
    return unrolled > 0 ? unrolled == plan.layersPerPlane : plan.planes == 1;
}

/// What cuts a ray's stay where it may be seen, or why cutting it costs less than not to.
ReasonId chosen(const PlanInput& in, const FramePlan& plan) {
    if (in.facts.isEdited) {
        return ReasonId::CutWhileEdited;
    }
    if (!plan.tighten) {
        return ReasonId::CutInWideOutlines;
    }
    if (!in.facts.facesAreClear) {
        return ReasonId::CutAtFaces;
    }
    // An interval that begins outside reaches one layer farther; a block is one voxel at least.
    if (plan.variant.classification == Classification::Preintegrated &&
        (plan.lattice.kind == LatticeKind::Planar ||
         plan.lattice.spacingMm > in.facts.smallestVoxelEdgeMm)) {
        return ReasonId::CutAtFaces;
    }
    if (plan.variant.exactField) {
        return ReasonId::CutSparesFetches;
    }
    return textEndsWithPlane(plan) ? ReasonId::NoCut : ReasonId::CutAtPlane;
}

} // namespace

Result<void> decideInterval(const PlanInput& in, FramePlan& plan) {
    const ReasonId reason = chosen(in, plan);
    plan.variant.interval = reason == ReasonId::NoCut ? Interval::None : Interval::Box;
    because(plan, reason);
    return {};
}

} // namespace slabcast

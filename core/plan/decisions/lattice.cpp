#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

/// Shells stay where they are when a head turns; planar layers swim by as much as they err. By the
/// model of phones, 16 planar layers a plane are no better for what they cost, and slices, which
/// are cheaper planar where faces cut rays, are dear in any case (perf/README.md, "Planar layers or
/// shells"). By the ratio it does not go: that never moves a sample, so that ratios can be
/// compared. The software driver draws planar layers a little faster.
LatticeKind latticeFor(const gl::Caps& caps) {
    return caps.isSoftware ? LatticeKind::Planar : LatticeKind::Shells;
}

ReasonId reasonOf(LatticeKind kind, bool asked) {
    if (kind == LatticeKind::Planar) {
        return asked ? ReasonId::PlanarLattice : ReasonId::PlanarLatticeHere;
    }
    return asked ? ReasonId::ShellsLattice : ReasonId::ShellsLatticeHere;
}

} // namespace

Result<void> decideLattice(const PlanInput& in, FramePlan& plan) {
    const auto& [facts, settings, caps, measurements] = in;
    const int total = totalLayers(settings, facts);
    const double diameterMm = 2.0 * facts.sphere.radiusMm;
    const double spacing = settings.totalLayers
                               ? diameterMm / *settings.totalLayers
                               : settings.layerSpacingVoxels * facts.smallestVoxelEdgeMm;
    if (total > kMaxTotalLayers) {
        return fail(ErrorCode::InvalidArgument,
                    "the layer spacing asks for " + std::to_string(total) +
                        " layers: at most 1048576; widen --layer-spacing");
    }
    const LatticeKind kind = settings.lattice.value_or(latticeFor(caps));
    plan.lattice = {kind, total, spacing, settings.jitter};
    plan.variant.lattice = kind;
    plan.variant.jittered = settings.jitter;
    because(plan, ReasonId::Layers,
            {double(total), spacing, spacing / facts.smallestVoxelEdgeMm, diameterMm});
    because(plan, reasonOf(kind, settings.lattice.has_value()));
    if (settings.jitter) {
        because(plan, ReasonId::Jitter);
    }
    return {};
}

} // namespace slabcast

#include "core/plan/decisions/decision.h"

namespace slabcast {

namespace {

/// With shells all layers are of one length, so their opacity lies in the table, and a layer takes
/// no exponential. By phones' compilers (perf/mobile) that is the cheaper text on a Mali, and on an
/// Adreno where nothing cuts rays; where something does, its text is an eighth longer there, but
/// few segments run the part that cuts. The software driver draws planar layers a little faster.
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

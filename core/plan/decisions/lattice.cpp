#include "core/plan/decisions/decision.h"

namespace slabcast {

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
    plan.lattice = {settings.lattice, total, spacing, settings.jitter};
    plan.variant.lattice = settings.lattice;
    plan.variant.jittered = settings.jitter;
    because(plan, ReasonId::Layers,
            {double(total), spacing, spacing / facts.smallestVoxelEdgeMm, diameterMm});
    because(plan, settings.lattice == LatticeKind::Planar ? ReasonId::PlanarLattice
                                                          : ReasonId::ShellsLattice);
    if (settings.jitter) {
        because(plan, ReasonId::Jitter);
    }
    return {};
}

} // namespace slabcast

#pragma once

#include "core/reference/discrete.h"

namespace slabcast::test {

/// One ray along the view's axis, through the centre of the volume.
inline DiscreteInput axisRay(const Texels& texels, const VolumeGeometry& geometry,
                             const DiscreteTransfer& transfer, const OrbitCamera& camera,
                             double spacingMm) {
    const BoundingSphere sphere = geometry.boundingSphere();
    DiscreteInput input;
    input.texels = &texels;
    input.geometry = geometry;
    input.transfer = transfer;
    input.view = {viewFromModel(camera, sphere), symmetricFrustum(30.0, 1.0), 0.0};
    input.viewport = {0, 0, 1, 1};
    input.lattice = {LatticeKind::Planar, layersToCover(sphere.radiusMm, spacingMm), spacingMm};
    return input;
}

inline glm::dvec4 onlyPixel(const DiscreteInput& input) {
    return renderDiscrete(input).at(0);
}

} // namespace slabcast::test

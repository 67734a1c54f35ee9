#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/preclassified.h"
#include "core/transfer/preintegrated.h"
#include "core/transfer/shading.h"
#include "core/transfer/transfer_function.h"
#include "core/view/lattice.h"
#include "core/volume/normals.h"
#include "core/volume/texels.h"

namespace slabcast {

/// Every voxel's colour and opacity of a reference length by the continuous TF, premultiplied, then
/// filtered: pre-classified texels without their eight bits.
struct PreclassifiedExact {
    TransferFunction tf;
    double referenceLengthMm = 1.0;
};

/// The continuous TF's mean over each interval between two samples: a pre-integrated table without
/// its texels.
struct PreintegratedExact {
    TransferFunction tf;
};

/// How samples become colours. Post-classified, pre-classified or pre-integrated: each by the
/// continuous TF, as it is meant, or by what the GPU holds (already in the compositing space; the
/// classified texels are borrowed).
using DiscreteTransfer =
    std::variant<TransferFunction, TransferTable, PreclassifiedExact, const ClassifiedTexels*,
                 PreintegratedExact, PreintegratedTable>;

/// What a lattice's samples are taken of. Borrows the texels: they must outlive it.
struct DiscreteInput {
    const Texels* texels = nullptr;
    VolumeGeometry geometry;
    DiscreteTransfer transfer;
    CompositingSpace space = CompositingSpace::Display;
    std::optional<ShadingParameters> shading; // none: unlit, as all but post-classified is
    const NormalTexels* normals = nullptr;    // baked; null: the field's own gradients
    View view;
    Viewport viewport;
    Lattice lattice;
};

/// The picture that the renderer approximates: its own samples (the lattice's code is shared on
/// purpose), each evaluated in float64 and composited front to back, every layer of every ray.
/// Nothing is skipped, left early or rounded; so what remains between the two is the GPU's
/// arithmetic, filter and target.
/// The field is trilinear in the stored texels' data values, clamped to the edge. A layer's opacity
/// is 1 - exp(-extinction * its length inside). A layer's sample is in its middle, or for
/// pre-integration there is one at either end of its part inside. Shading is shading.h's model
/// under a head light: light and eye lie in one direction, the gradient is by central differences
/// of the field, half a voxel to each side, in patient space, or of baked normals. Premultiplied
/// RGBA in the compositing space, row by row from the bottom. Cost: O(pixels * layers met), all
/// cores. Tested by: discrete_test.cpp
std::vector<glm::dvec4> renderDiscrete(const DiscreteInput& input);

} // namespace slabcast

#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "core/frame/lattice.h"
#include "core/transfer/shading.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

namespace slabcast {

/// What a lattice's samples are taken of. Borrows the texels: they must outlive it.
struct DiscreteInput {
    const Texels* texels = nullptr;
    VolumeGeometry geometry;
    /// Continuous, as it is meant; or the table, as the GPU filters it (already in the compositing
    /// space).
    std::variant<TransferFunction, TransferTable> transfer;
    CompositingSpace space = CompositingSpace::Display;
    std::optional<ShadingParameters> shading; // none: unlit
    View view;
    Viewport viewport;
    Lattice lattice;
};

/// The picture that the renderer approximates: its own samples (the lattice's code is shared on
/// purpose), each evaluated in float64 and composited front to back, every layer of every ray.
/// Nothing is skipped, left early or rounded; so what remains between the two is the GPU's
/// arithmetic, filter and target.
/// The field is trilinear in the stored texels' data values, clamped to the edge. A layer's opacity
/// is 1 - exp(-extinction * its length inside). Shading is shading.h's model under a head light:
/// light and eye lie in one direction, the gradient is by central differences of the field, half a
/// voxel to each side, in patient space.
/// Premultiplied RGBA in the compositing space, row by row from the bottom.
/// Cost: O(pixels * layers met), all cores. Tested by: discrete_test.cpp
std::vector<glm::dvec4> renderDiscrete(const DiscreteInput& input);

} // namespace slabcast

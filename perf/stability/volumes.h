#pragma once

#include <functional>

#include "core/transfer/transfer_function.h"
#include "core/volume/volume.h"

namespace slabcast::stability {

/// A volume whose voxels follow a formula of their index. Values are rounded for integer types.
Volume formulaVolume(glm::ivec3 dims, VoxelType type,
                     const std::function<double(glm::ivec3)>& formula,
                     glm::dvec3 spacingMm = glm::dvec3(1.0));

/// One material, whatever the value.
TransferFunction uniformTransfer(double opacity, glm::dvec3 color, double opacityUnitMm = 1.0);

} // namespace slabcast::stability

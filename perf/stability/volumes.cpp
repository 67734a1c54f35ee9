#include "perf/stability/volumes.h"

#include <cmath>
#include <type_traits>

#include "core/volume/voxel_dispatch.h"

namespace slabcast::stability {

Volume formulaVolume(glm::ivec3 dims, VoxelType type,
                     const std::function<double(glm::ivec3)>& formula, glm::dvec3 spacingMm) {
    Volume volume;
    volume.name = "formula";
    volume.type = type;
    volume.geometry.dims = dims;
    volume.geometry.spacingMm = spacingMm;
    volume.voxels.resize(static_cast<std::size_t>(volume.geometry.voxelCount()) *
                         bytesPerVoxel(type));
    visitVoxels(volume, [&]<class T>(std::span<T> voxels) {
        std::size_t index = 0;
        for (int z = 0; z < dims.z; ++z) {
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x) {
                    const double value = formula({x, y, z});
                    voxels[index++] =
                        static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
                }
            }
        }
    });
    Result<Volume> checked = validated(std::move(volume));
    SLABCAST_EXPECTS(checked.has_value(), dims.x);
    return std::move(*checked);
}

TransferFunction uniformTransfer(double opacity, glm::dvec3 color, double opacityUnitMm) {
    return {.name = "uniform", .opacityUnitMm = opacityUnitMm, .points = {{0.0, color, opacity}}};
}

} // namespace slabcast::stability

#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "core/transfer/transfer_function.h"
#include "core/view/view.h"
#include "core/volume/texels.h"

namespace slabcast::test {

/// Voxels from a formula of their index, as T.
template <class T>
Volume volumeOf(const VolumeGeometry& geometry, VoxelType type,
                const std::function<double(glm::ivec3)>& value) {
    Volume volume;
    volume.type = type;
    volume.geometry = geometry;
    volume.voxels.resize(static_cast<std::size_t>(geometry.voxelCount()) * sizeof(T));
    std::size_t at = 0;
    for (int z = 0; z < geometry.dims.z; ++z) {
        for (int y = 0; y < geometry.dims.y; ++y) {
            for (int x = 0; x < geometry.dims.x; ++x, at += sizeof(T)) {
                const T voxel = static_cast<T>(value({x, y, z}));
                std::memcpy(&volume.voxels[at], &voxel, sizeof(T));
            }
        }
    }
    return validated(std::move(volume)).value();
}

/// Kept exactly: float32 voxels in float32 texels.
inline Texels floatTexels(const VolumeGeometry& geometry,
                          const std::function<double(glm::ivec3)>& value) {
    const Volume volume = volumeOf<float>(geometry, VoxelType::F32, value);
    return encodeTexels(volume, computeStatistics(volume), TexelFormat::R32fExact);
}

inline TransferFunction tfOf(std::vector<TransferPoint> points, double unitMm = 1.0) {
    TransferFunction tf;
    tf.opacityUnitMm = unitMm;
    tf.points = std::move(points);
    return validated(tf).value();
}

/// A field that rises by one per voxel along z, in a box that a ray at 30 degrees to the xy plane
/// enters and leaves through its x faces: along the ray the field is linear from end to end.
struct ObliqueRamp {
    static constexpr int kDim = 16;
    VolumeGeometry geometry{.dims = glm::ivec3(kDim), .spacingMm = {1.0, 1.0, 2.0}};
    OrbitCamera camera{.azimuthDegrees = 90.0, .elevationDegrees = 30.0, .distanceRadii = 3.0};
    Texels texels = floatTexels(geometry, [](glm::ivec3 v) { return v.z; });

    double lengthMm() const { return kDim / std::cos(M_PI / 6.0); }
    double risePerMm() const {
        return -std::sin(M_PI / 6.0) / geometry.spacingMm.z;
    } // the ray goes down
    double first() const { return (kDim - 1) / 2.0 - risePerMm() * lengthMm() / 2.0; }
};

} // namespace slabcast::test

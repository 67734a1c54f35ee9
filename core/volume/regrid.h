#pragma once

#include <cmath>
#include <type_traits>

#include "core/volume/volume.h"

namespace slabcast {

/// The same box in space, cut into other voxels: spacing grows as their number falls.
VolumeGeometry sameBox(const VolumeGeometry& geometry, glm::ivec3 dims);

/// All of a volume but its voxels, with room for those of another grid over the same box.
Volume emptyOverSameBox(const Volume& volume, glm::ivec3 dims);

/// Integers round to nearest, halves away from zero.
template <class T>
T roundedTo(double value) {
    if constexpr (std::is_integral_v<T>) {
        return static_cast<T>(std::llround(value));
    } else {
        return static_cast<T>(value);
    }
}

} // namespace slabcast

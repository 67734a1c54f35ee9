#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "core/volume/volume.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast::test {

template <class T>
VoxelType typeOf() {
    for (int i = 0; i < 8; ++i) {
        const auto type = static_cast<VoxelType>(i);
        if (visitVoxelType(type,
                           []<class U>(std::type_identity<U>) { return std::is_same_v<T, U>; })) {
            return type;
        }
    }
    ADD_FAILURE();
    return VoxelType::U8;
}

template <class T>
Volume volumeOf(glm::ivec3 dims, const std::vector<T>& voxels) {
    Volume volume;
    volume.type = typeOf<T>();
    volume.geometry.dims = dims;
    volume.voxels.resize(voxels.size() * sizeof(T));
    std::memcpy(volume.voxels.data(), voxels.data(), volume.voxels.size());
    return volume;
}

} // namespace slabcast::test

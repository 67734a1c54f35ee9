#pragma once

#include <span>
#include <type_traits>
#include <utility>

#include "core/volume/volume.h"

namespace slabcast {

/// Calls `visit(std::type_identity<T>{})` with the C++ type of the voxels: the one switch over
/// voxel types.
template <class Visitor>
decltype(auto) visitVoxelType(VoxelType type, Visitor&& visit) {
    switch (type) {
    case VoxelType::U8:
        return visit(std::type_identity<std::uint8_t>{});
    case VoxelType::I8:
        return visit(std::type_identity<std::int8_t>{});
    case VoxelType::U16:
        return visit(std::type_identity<std::uint16_t>{});
    case VoxelType::I16:
        return visit(std::type_identity<std::int16_t>{});
    case VoxelType::U32:
        return visit(std::type_identity<std::uint32_t>{});
    case VoxelType::I32:
        return visit(std::type_identity<std::int32_t>{});
    case VoxelType::F32:
        return visit(std::type_identity<float>{});
    case VoxelType::F64:
        return visit(std::type_identity<double>{});
    }
    contractBreach(__func__, "a voxel type", static_cast<double>(type));
}

/// Calls `visit(std::span<const T>)` with all stored voxels. A volume's bytes come from an
/// allocator or are pages, so they are aligned for every voxel type.
template <class Visitor>
decltype(auto) visitVoxels(const Volume& volume, Visitor&& visit) {
    return visitVoxelType(volume.type, [&]<class T>(std::type_identity<T>) -> decltype(auto) {
        return visit(std::span<const T>(reinterpret_cast<const T*>(volume.voxels.data()),
                                        volume.voxels.size() / sizeof(T)));
    });
}

/// The same, to write.
template <class Visitor>
decltype(auto) visitVoxels(Volume& volume, Visitor&& visit) {
    return visitVoxelType(volume.type, [&]<class T>(std::type_identity<T>) -> decltype(auto) {
        return visit(std::span<T>(reinterpret_cast<T*>(volume.voxels.data()),
                                  volume.voxels.size() / sizeof(T)));
    });
}

} // namespace slabcast

#include "core/volume/voxel_bytes.h"

#include <algorithm>
#include <cstdlib>

namespace slabcast {

VoxelBytes::VoxelBytes(std::size_t size) : size_(size) {
    if (size == 0) {
        return;
    }
    // From the system's zeros: large memory takes no room before it is written to.
    auto* bytes = static_cast<std::byte*>(std::calloc(size, 1));
    if (bytes == nullptr) { // fails as `new` does, with exceptions and without
        bytes_ = {new std::byte[size](), [](std::byte* own) { delete[] own; }};
        return;
    }
    bytes_ = {bytes, [](std::byte* own) { std::free(own); }};
}

VoxelBytes::VoxelBytes(std::span<const std::byte> bytes) : VoxelBytes(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), begin());
}

VoxelBytes VoxelBytes::adopted(std::byte* data, std::size_t size,
                               std::function<void(std::byte*)> release) {
    VoxelBytes adopted;
    adopted.bytes_ = {data, std::move(release)};
    adopted.size_ = size;
    return adopted;
}

void VoxelBytes::resize(std::size_t size) {
    if (size > size_) {
        VoxelBytes larger(size);
        std::copy(begin(), end(), larger.begin());
        swap(larger);
    }
    size_ = size;
}

} // namespace slabcast

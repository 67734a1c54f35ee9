#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace slabcast {

/// The bytes of a volume's voxels: memory of its own, or memory that somebody else made, such as a
/// mapping of a file or of another process. Copies are of its own memory. Not to be used by two
/// threads while one writes. Tested by: volume_test.cpp
class VoxelBytes {
public:
    VoxelBytes() = default;
    /// So many zeros.
    explicit VoxelBytes(std::size_t size);
    /// A copy.
    VoxelBytes(std::span<const std::byte> bytes);
    VoxelBytes(std::initializer_list<std::byte> bytes)
        : VoxelBytes(std::span<const std::byte>(bytes.begin(), bytes.size())) {}
    VoxelBytes(const std::vector<std::byte>& bytes)
        : VoxelBytes(std::span<const std::byte>(bytes.data(), bytes.size())) {}
    VoxelBytes(const VoxelBytes& other)
        : VoxelBytes(std::span<const std::byte>(other.data(), other.size())) {}
    VoxelBytes(VoxelBytes&& other) noexcept { swap(other); }
    VoxelBytes& operator=(VoxelBytes other) noexcept {
        swap(other);
        return *this;
    }
    ~VoxelBytes() = default;

    /// Writable memory that lives until `release` is called with it, once.
    static VoxelBytes adopted(std::byte* data, std::size_t size,
                              std::function<void(std::byte*)> release);

    std::byte* data() { return bytes_.get(); }
    const std::byte* data() const { return bytes_.get(); }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::byte& operator[](std::size_t i) { return bytes_[i]; }
    const std::byte& operator[](std::size_t i) const { return bytes_[i]; }
    std::byte* begin() { return data(); }
    std::byte* end() { return data() + size_; }
    const std::byte* begin() const { return data(); }
    const std::byte* end() const { return data() + size_; }

    /// Fewer keep their memory; more are copied into new memory, zeros behind them.
    void resize(std::size_t size);

    friend bool operator==(const VoxelBytes& a, const VoxelBytes& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }

private:
    void swap(VoxelBytes& other) noexcept {
        bytes_.swap(other.bytes_);
        std::swap(size_, other.size_);
    }

    std::unique_ptr<std::byte[], std::function<void(std::byte*)>> bytes_;
    std::size_t size_ = 0;
};

} // namespace slabcast

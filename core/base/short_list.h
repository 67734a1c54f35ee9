#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

#include "core/base/error.h"

namespace slabcast {

/// At most so many, in place, not on the heap. Contract: no more. Tested by: contracts_test.cpp
template <class T, std::size_t most>
class ShortList {
public:
    constexpr ShortList() = default;
    constexpr ShortList(std::initializer_list<T> items) {
        for (const T& item : items) {
            add(item);
        }
    }

    constexpr void add(const T& item) {
        SLABCAST_EXPECTS(size_ < most, size_);
        items_[size_++] = item;
    }
    constexpr std::size_t size() const { return size_; }
    constexpr bool empty() const { return size_ == 0; }
    constexpr bool full() const { return size_ == most; }
    constexpr const T* begin() const { return items_.data(); }
    constexpr const T* end() const { return items_.data() + size_; }
    constexpr const T& operator[](std::size_t k) const { return items_[k]; }

private:
    std::array<T, most> items_{};
    std::size_t size_ = 0;
};

} // namespace slabcast

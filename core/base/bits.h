#pragma once

#include <cstring>
#include <type_traits>

namespace slabcast {

/// The bytes of a value as a value of another type of the same size. It is std::bit_cast, which the
/// standard library of Emscripten 3.1.6 does not have yet. Tested by: texels_test.cpp
template <class To, class From>
To bitsAs(const From& from) {
    static_assert(sizeof(To) == sizeof(From));
    static_assert(std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

} // namespace slabcast

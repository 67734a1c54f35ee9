#pragma once

#include <string>
#include <string_view>

namespace slabcast {

/// Text of unknown origin, fit for a line: '?' in the place of control characters.
inline std::string withoutControls(std::string_view text) {
    std::string shown(text);
    for (char& c : shown) {
        c = static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    }
    return shown;
}

} // namespace slabcast

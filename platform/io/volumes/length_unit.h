#pragma once

#include <optional>
#include <string_view>

namespace slabcast {

/// "mm", "micrometer", "µm" (UTF-8 or Latin-1), "m", ... in either case; nothing for what is no
/// length. Tested by: io_header_test.cpp
std::optional<double> millimetresPer(std::string_view unit);

/// Whether it says nothing: "", "???", "none", "unknown".
bool isNoUnit(std::string_view unit);

} // namespace slabcast

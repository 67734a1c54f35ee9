#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace slabcast {

/// The fewest digits from which the same number is read again, always with a point: "0.1",
/// "1e-06". The host's locale does not matter. Tested by: settings_table_test.cpp
std::string numberText(double value);

/// The whole text as a number, with a point whatever the locale; nothing for anything else, for
/// "nan" and "inf", and for what is beyond float64.
std::optional<double> numberFrom(std::string_view text);

} // namespace slabcast

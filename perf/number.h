#pragma once

#include <string>

namespace slabcast {

// Numbers as text, with a point whatever the host's locale. Tested by: frame_times_test.cpp

/// As "%g" writes it, with so many digits: 0.333, 1.2e-05.
std::string number(double value, int digits = 3);
/// As "%f" writes it, with so many digits after the point: 0.9961.
std::string fixed(double value, int digits);

} // namespace slabcast

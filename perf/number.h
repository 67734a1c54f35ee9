#pragma once

#include <string>

namespace slabcast {

/// As "%g" writes it, with so many digits: 0.333, 1.2e-05.
std::string number(double value, int digits = 3);

} // namespace slabcast

#include "perf/number.h"

#include <cstdio>

namespace slabcast {

std::string number(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

} // namespace slabcast

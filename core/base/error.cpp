#include "core/base/error.h"

#include <cstdio>
#include <cstdlib>

namespace slabcast {

void contractBreach(const char* function, const char* condition, double value) {
    std::fprintf(stderr, "slabcast: %s: expects %s, got %g\n", function, condition, value);
    std::abort();
}

} // namespace slabcast

# Writes OUT, a C++ source that names the commit of SOURCE as it is now. Runs at every build and leaves an equal file
# alone, so that reports name what was built and nothing is compiled for it in vain.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
    set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
#include "platform/cli/commit.h"

namespace slabcast {

const char* commit() { return "@commit@"; }

} // namespace slabcast
]] @ONLY)

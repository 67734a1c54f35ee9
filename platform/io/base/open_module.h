#pragma once

#include "core/base/error.h"

namespace slabcast {

/// The address of `symbol` in a module: a library that is opened when something first needs it, and
/// never closed. The dynamic linker looks for it, as for every library, in LD_LIBRARY_PATH and
/// along the program's run path, which CMake sets for `slabcast` and for what links Slabcast::io.
/// Fails: FileUnreadable; the detail is the cause alone. Tested by: io_libraries_test.cpp
Result<void*> openModule(const char* fileName, const char* symbol);

/// What is wrong with a module that opens and is not this build's.
tl::unexpected<Error> otherVersion(const char* fileName);

} // namespace slabcast

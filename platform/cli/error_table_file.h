#pragma once

#include <vector>

#include "core/gl/caps.h"
#include "perf/error/error_table.h"

namespace slabcast {

// What `slabcast error` measured on this device, for `slabcast render --target-error`: kept by
// device_cache.h as error-table.

/// Empty where there is no file. Fails: InvalidArgument (neither XDG_CACHE_HOME nor HOME is set),
/// FileUnreadable (also of what refreshErrorTable() did not write).
Result<std::vector<MeasuredError>> readErrorTable(const gl::Caps& caps);

/// Puts `fresh` in place of what the file has of the same kind. Makes the folder where it is
/// missing. Fails: as readErrorTable(), FileUnwritable.
Result<void> refreshErrorTable(const gl::Caps& caps, const std::vector<MeasuredError>& fresh);

} // namespace slabcast

#pragma once

#include "perf/json.h"

namespace slabcast::skipbench {

/// What the papers measured on their devices, with where it stands: milliseconds as published, to
/// be compared as ratios within one line only.
Json publishedTables();

} // namespace slabcast::skipbench

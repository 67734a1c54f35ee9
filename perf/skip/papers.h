#pragma once

#include <nlohmann/json_fwd.hpp>

namespace slabcast::skipbench {

/// What the papers measured on their devices, with where it stands: milliseconds as published, to
/// be compared as ratios within one line only.
nlohmann::json publishedTables();

} // namespace slabcast::skipbench

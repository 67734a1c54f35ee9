#pragma once

#include <nlohmann/json.hpp>

namespace slabcast {

/// What the papers measured on their devices, with where it stands: milliseconds as published, to
/// be compared as ratios within one line only.
nlohmann::json publishedTables();

} // namespace slabcast

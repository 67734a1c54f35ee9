#pragma once

#include <nlohmann/json.hpp>

#include "platform/cli/options.h"
#include "platform/cli/progress.h"

namespace slabcast {

/// How cost grows: the volume resampled to cubes of the options' sizes, every structure with its
/// usual parameters: what it takes to build, to hold, and a frame of ray casting, marching only.
/// Rows of the table "sizes". Opens a stage of its own for each.
Result<nlohmann::json> measureSizes(const SkipbenchOptions& options, const SceneOptions& volume,
                                    const std::string& label, Progress& progress);

} // namespace slabcast

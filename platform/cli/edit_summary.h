#pragma once

#include <vector>

#include "platform/cli/edit_bench.h"

namespace slabcast {

// What was measured of an edit, for its report. Keys are stable: people plot them.

nlohmann::json toJson(const EditRow& row, std::size_t index);

nlohmann::json summaryOf(const std::vector<EditRow>& rows, const EditOptions& options);

} // namespace slabcast

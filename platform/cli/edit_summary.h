#pragma once

#include <vector>

#include "platform/cli/edit_bench.h"

namespace slabcast {

// What was measured of an edit, for its report. Keys are stable: people plot them.

/// Of replays of the same script: each frame's times are medians, and it is equal where it always
/// was; all else is the first replay's. Contract: one at least.
std::vector<EditRow> mediansOf(const std::vector<std::vector<EditRow>>& replays);

/// The slowest frame of any replay, in octree frames of its own time.
double worstOverOctree(const std::vector<std::vector<EditRow>>& replays);

nlohmann::json toJson(const EditRow& row, std::size_t index);

nlohmann::json summaryOf(const std::vector<EditRow>& rows, const EditOptions& options);

} // namespace slabcast

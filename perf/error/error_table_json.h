#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "perf/error/error_table.h"
#include "perf/stage.h"

namespace slabcast {

// What was measured on a device, as a file keeps it. Tested by: error_grid_test.cpp

std::string errorTableText(const std::vector<MeasuredError>& table);

/// Fails: FileUnreadable, with what is wrong in a few words (also of what errorTableText() did not
/// write).
Result<std::vector<MeasuredError>> parseErrorTable(std::string_view text);

/// `table` with `fresh` in place of what it has of the same scenes, sizes and samplings, and of
/// what builds of other commits measured.
std::vector<MeasuredError> refreshed(std::vector<MeasuredError> table,
                                     const std::vector<MeasuredError>& fresh);

/// Of the stage's scene under its look.
SceneLabel labelOf(const Stage& stage);

/// Whether all that a sampling does not name is as it is unless told otherwise: an error table
/// holds nothing else.
bool hasUsualSettings(const StageDesc& desc);

} // namespace slabcast

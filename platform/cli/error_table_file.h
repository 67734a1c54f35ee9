#pragma once

#include <filesystem>
#include <vector>

#include "perf/error/error_table.h"
#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

// What `slabcast error` measured on this device, for `slabcast render --target-error`.

/// `slabcast/error-table-DEVICE.json` in the user's folder for caches (XDG_CACHE_HOME, else
/// ~/.cache). Fails: InvalidArgument (neither XDG_CACHE_HOME nor HOME is set).
Result<std::filesystem::path> errorTablePath(const gl::Caps& caps);

/// Empty where there is no file. Fails: FileUnreadable (also of what writeErrorTable() did not
/// write).
Result<std::vector<MeasuredError>> readErrorTable(const std::filesystem::path& path);

/// Makes the folder where it is missing. Fails: FileUnwritable.
Result<void> writeErrorTable(const std::filesystem::path& path,
                             const std::vector<MeasuredError>& table);

/// `table` with `fresh` in place of what it has of the same scenes, sizes and samplings, and of
/// what builds of other commits measured.
std::vector<MeasuredError> refreshed(std::vector<MeasuredError> table,
                                     const std::vector<MeasuredError>& fresh);

/// The stage's scene as the table names it: the volume with its dimensions, however it is sampled.
SceneLabel labelOf(const Stage& stage);

} // namespace slabcast

#pragma once

#include <filesystem>
#include <string>

#include "perf/report_json.h"

namespace slabcast {

// What commands that measure into a folder have in common.

/// Makes the folder, and those above it. Fails: FileUnwritable, naming --out.
Result<void> makeReportFolder(const std::filesystem::path& folder);

/// This run, of the command as it was typed.
RunInfo runOf(const std::string& command);

/// The page is made by a script from the JSON, so that it can be made again: `script` is its name
/// in perf/. Fails: FileUnwritable, saying that `written` are there and how to make the page.
Result<void> writePage(const std::filesystem::path& folder, const std::string& script,
                       const std::string& written);

} // namespace slabcast

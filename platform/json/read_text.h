#pragma once

#include <string>

#include "core/base/error.h"

namespace slabcast {

/// A file's whole text; `what` it is, for the refusal. Fails: FileNotFound, FileUnreadable.
/// Tested by: transfer_json_test.cpp, cli_usage_test.py
Result<std::string> readText(const std::string& path, const std::string& what);

} // namespace slabcast

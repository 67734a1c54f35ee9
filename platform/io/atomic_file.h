#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "core/base/error.h"

namespace slabcast {

/// Whether a file could be written at `path`, as far as can be known beforehand; to be asked before
/// long work. Fails: FileUnwritable (no such folder, no permission, `path` is a folder or device).
Result<void> checkWritable(const std::filesystem::path& path);

/// Fills the file that it is given, under a temporary name. A failure is handed on.
using FileWriter = std::function<Result<void>(const std::filesystem::path& temporary)>;

/// Writes beside `path` under a temporary name with the same ending and renames when all is
/// written: `path` holds its old content or the whole new one, and a failure leaves nothing
/// behind.
/// Fails: FileUnwritable (no such folder, no permission, disk full, `path` is a folder or
/// device), and what `write` fails with. Tested by: io_write_test.cpp
Result<void> writeFileAtomically(const std::filesystem::path& path, const FileWriter& write);
Result<void> writeFileAtomically(const std::filesystem::path& path, std::string_view content);

} // namespace slabcast

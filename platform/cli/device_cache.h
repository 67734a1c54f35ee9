#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/gl/caps.h"

namespace slabcast {

/// `slabcast/KIND-DEVICE.json` in the user's folder for caches (XDG_CACHE_HOME, else ~/.cache).
/// `what` it holds, for the error. Fails: InvalidArgument (neither XDG_CACHE_HOME nor HOME is set).
Result<std::filesystem::path> deviceCachePath(const std::string& kind, const std::string& what,
                                              const gl::Caps& caps);

/// Makes the folder where it is missing, and writes the file whole. Fails: FileUnwritable.
Result<void> writeDeviceCache(const std::filesystem::path& path, const std::string& text);

/// A file's whole content; nothing where there is no file. Fails: FileUnreadable.
Result<std::optional<std::string>> readDeviceCache(const std::filesystem::path& path);

} // namespace slabcast

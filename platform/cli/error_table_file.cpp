#include "platform/cli/error_table_file.h"

#include <filesystem>

#include "perf/error/error_table_json.h"
#include "platform/cli/device_cache.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;

Result<fs::path> errorTablePath(const gl::Caps& caps) {
    return deviceCachePath("error-table", "the table of measured errors", caps);
}

Result<std::vector<MeasuredError>> readTable(const fs::path& path) {
    return readDeviceCache(path)
        .and_then([](const std::optional<std::string>& text) {
            return text ? parseErrorTable(*text) : std::vector<MeasuredError>{};
        })
        .map_error([&](const Error& error) {
            return Error{error.code, path.string() + ": no table of measured errors (" +
                                         error.detail +
                                         "): delete it and run `slabcast error` anew"};
        });
}

} // namespace

Result<std::vector<MeasuredError>> readErrorTable(const gl::Caps& caps) {
    return errorTablePath(caps).and_then(readTable);
}

Result<void> refreshErrorTable(const gl::Caps& caps, const std::vector<MeasuredError>& fresh) {
    const Result<fs::path> path = errorTablePath(caps);
    if (!path) {
        return tl::unexpected(path.error());
    }
    return readTable(*path).and_then([&](std::vector<MeasuredError> table) {
        return writeDeviceCache(*path, errorTableText(refreshed(std::move(table), fresh)));
    });
}

} // namespace slabcast

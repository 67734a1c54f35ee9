#include "platform/cli/error_table_file.h"

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "perf/error/error_table_json.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;

Result<fs::path> errorTablePath(const gl::Caps& caps) {
    const auto folderIn = [](const char* variable) {
        const char* value = std::getenv(variable);
        return fs::path(value == nullptr ? "" : value);
    };
    fs::path cache = folderIn("XDG_CACHE_HOME");
    if (cache.empty() && !folderIn("HOME").empty()) {
        cache = folderIn("HOME") / ".cache";
    }
    if (cache.empty()) {
        return fail(ErrorCode::InvalidArgument, "there is no place for the table of measured "
                                                "errors: set XDG_CACHE_HOME or HOME");
    }
    std::string file = "error-table";
    bool apart = true;
    for (const unsigned char c : caps.renderer) {
        if (std::isalnum(c) != 0) {
            file += std::string(apart ? "-" : "") + static_cast<char>(std::tolower(c));
        }
        apart = std::isalnum(c) == 0;
    }
    return cache / "slabcast" / (file + ".json");
}

Result<std::vector<MeasuredError>> readTable(const fs::path& path) {
    std::error_code ignored; // what cannot be asked after cannot be read either: said below
    if (fs::status(path, ignored).type() == fs::file_type::not_found) {
        return std::vector<MeasuredError>{};
    }
    std::ifstream file(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    Result<std::vector<MeasuredError>> table =
        file.bad() || !file.is_open() ? fail(ErrorCode::FileUnreadable, "it cannot be read")
                                      : parseErrorTable(text);
    return std::move(table).map_error([&](const Error& error) {
        return Error{error.code, path.string() + ": no table of measured errors (" + error.detail +
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
        std::error_code ignored; // what cannot be made is reported as a folder that is not there
        fs::create_directories(path->parent_path(), ignored);
        return writeFileAtomically(*path, errorTableText(refreshed(std::move(table), fresh)));
    });
}

} // namespace slabcast

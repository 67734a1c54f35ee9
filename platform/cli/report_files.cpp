#include "platform/cli/report_files.h"

#include <algorithm>
#include <ctime>

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kThumbnailEdge = 192;

/// Runs a program of these words and waits for it; what it prints goes to stderr. True where it
/// ends well.
bool run(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    pid_t child = 0;
    const bool started =
        posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    return started && waitpid(child, &status, 0) == child && status == 0;
}

/// Quoted where it holds what separates cells or lines.
std::string csvCell(const json& row, const char* pointer) {
    const json::json_pointer place(pointer);
    const json value = row.contains(place) ? row.at(place) : json();
    if (!value.is_string()) {
        return value.is_null() ? "" : value.dump();
    }
    std::string text = value.get<std::string>();
    if (text.find_first_of(",\"\n") == std::string::npos) {
        return text;
    }
    for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) {
        text.insert(at, 1, '"');
    }
    return '"' + text + '"';
}

} // namespace

Result<void> makeReportFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        return fail(ErrorCode::FileUnwritable,
                    fmt::format("{}: cannot make this folder ({}): give another to --out",
                                folder.string(), error.message()));
    }
    return {};
}

std::string timestamp() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

json reportHeader(const Stage& stage, const std::string& command) {
    return {{"command", command},
            {"commit", commit()},
            {"date", timestamp()},
            {"device", toJson(stage.session().caps)},
            {"volume", toJson(stage.info())}};
}

std::vector<CsvColumn> columnsOf(std::initializer_list<std::span<const CsvColumn>> parts) {
    std::vector<CsvColumn> columns;
    for (const std::span<const CsvColumn> part : parts) {
        columns.insert(columns.end(), part.begin(), part.end());
    }
    return columns;
}

std::string csvOf(const json& rows, std::span<const CsvColumn> columns) {
    std::string text;
    const auto addLine = [&](auto&& cellOf) {
        for (const CsvColumn& column : columns) {
            text += cellOf(column) + ",";
        }
        text.back() = '\n';
    };
    addLine([](const CsvColumn& column) { return std::string(column.heading); });
    for (const json& row : rows) {
        addLine([&row](const CsvColumn& column) { return csvCell(row, column.pointer); });
    }
    return text;
}

SmallPicture thumbnail(glm::ivec2 size, const std::vector<glm::vec4>& picture) {
    const int shrink = std::max(1, std::max(size.x, size.y) / kThumbnailEdge);
    const glm::ivec2 small = glm::max(size / shrink, glm::ivec2(1));
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(small.x) * small.y, glm::vec4(0.0F));
    for (int y = 0; y < small.y * shrink && y < size.y; ++y) {
        for (int x = 0; x < small.x * shrink && x < size.x; ++x) {
            pixels[static_cast<std::size_t>(y / shrink) * small.x + x / shrink] +=
                picture[static_cast<std::size_t>(y) * size.x + x] /
                static_cast<float>(shrink * shrink);
        }
    }
    return {small, std::move(pixels)};
}

Result<void> writePage(const fs::path& folder, const std::string& script,
                       const std::string& written) {
    const fs::path installed =
        fs::read_symlink("/proc/self/exe").parent_path() / "../share/slabcast/perf" / script;
    const fs::path path =
        fs::exists(installed) ? installed : fs::path(SLABCAST_PERF_FOLDER) / script;
    if (!run({"/usr/bin/python3", path.string(), folder.string()})) {
        return fail(ErrorCode::FileUnwritable,
                    fmt::format("{0}: {1} are written, report.html is not: install "
                                "python3-matplotlib, then run {2} {0}",
                                folder.string(), written, path.string()));
    }
    return {};
}

} // namespace slabcast

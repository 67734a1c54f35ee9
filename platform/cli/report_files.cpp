#include "platform/cli/report_files.h"
#include "perf/csv.h"
#include "perf/report_folder.h"

#include <vector>

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/cli/commit.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;

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

RunInfo runOf(const std::string& command) {
    return {command, commit()};
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

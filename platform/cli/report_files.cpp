#include "platform/cli/report_files.h"
#include "perf/csv.h"
#include "perf/report_folder.h"

#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/cli/commit.h"
#include "platform/cli/interrupt.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/session.h"
#include "platform/io/atomic_file.h"

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
    std::optional<SignalsHeld> held(std::in_place);
    posix_spawnattr_t attributes; // a group of its own: Ctrl-C is for this program
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, &held->before());
    pid_t child = 0;
    const bool started =
        posix_spawnp(&child, arguments[0], &actions, &attributes, arguments.data(), environ) == 0;
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (!started) {
        return false;
    }
    const Awaited ends(child);
    held.reset();
    int status = 0;
    return waitpid(child, &status, 0) == child && status == 0;
}

} // namespace

DiskFolder::DiskFolder(const FolderOptions& options, std::string inner)
    : path_(options.path), inner_(std::move(inner)), fresh_(options.fresh) {
    std::error_code ignored; // what cannot be asked after is not this program's to remove
    made_ = fs::status(path_, ignored).type() == fs::file_type::not_found;
    if (made_) {
        unfinished_.emplace(path_);
        unfinishedInner_.emplace(path_ / inner_);
    }
}

DiskFolder::~DiskFolder() {
    std::error_code ignored; // where it is not empty it stays
    if (made_) {
        fs::remove(path_ / inner_, ignored);
        fs::remove(path_, ignored);
    }
}

Result<void> DiskFolder::make(const std::string& file) const {
    std::error_code error;
    fs::create_directories(path_ / inner_, error);
    if (error) {
        return fail(ErrorCode::FileUnwritable, path_.string() + ": cannot make this folder (" +
                                                   error.message() + "): give another to --out");
    }
    return checkWritable(path_ / file);
}

Result<void> DiskFolder::write(const std::string& file, std::string_view content) {
    return writeFileAtomically(path_ / file, content);
}

Result<void> DiskFolder::savePicture(const std::string& file, const ReportPicture& picture) {
    return slabcast::savePicture(path_ / file, picture.size, picture.pixels, true);
}

bool DiskFolder::has(const std::string& file) const {
    std::error_code ignored; // what cannot be asked after is not there
    return fs::exists(path_ / file, ignored);
}

void DiskFolder::remove(const std::string& file) {
    std::error_code ignored; // it is replaced, if not removed
    fs::remove(path_ / file, ignored);
}

std::optional<std::string> DiskFolder::read(const std::string& file) const {
    std::ifstream in(path_ / file, std::ios::binary);
    if (!in) {
        return std::nullopt;
    }
    return std::string(std::istreambuf_iterator<char>(in), {});
}

Result<void> DiskFolder::makePage(const std::string& script, const std::string& written) const {
    const fs::path installed =
        fs::read_symlink("/proc/self/exe").parent_path() / "../share/slabcast/perf" / script;
    const fs::path path =
        fs::exists(installed) ? installed : fs::path(SLABCAST_PERF_FOLDER) / script;
    if (!run({"/usr/bin/python3", path.string(), path_.string()})) {
        return fail(ErrorCode::FileUnwritable,
                    fmt::format("{0}: {1} are written, report.html is not: install "
                                "python3-matplotlib, then run {2} {0}",
                                path_.string(), written, path.string()));
    }
    return {};
}

RunInfo runOf(const std::string& command) {
    return {command, commit(), peakHostBytes};
}

} // namespace slabcast

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "platform/io/unfinished.h"

namespace slabcast {

/// Where a report goes, as the command line has it.
struct FolderOptions {
    std::string path;
    bool fresh = false; // what a run left there may be replaced
};

/// A report's folder on disk: made before long work, gone again, if it was made here, where that
/// work fails, or is interrupted, before anything is written.
class DiskFolder : public ReportFolder {
public:
    /// With a folder of this name in it, where one is named.
    explicit DiskFolder(const FolderOptions& options, std::string inner = {});
    DiskFolder(const DiskFolder&) = delete;
    DiskFolder& operator=(const DiskFolder&) = delete;
    ~DiskFolder() override;

    /// Makes it and those above it. Fails: FileUnwritable, naming --out where it cannot be made;
    /// also where `file` could not be written in it.
    Result<void> make(const std::string& file) const;

    std::string name() const override { return path_.string(); }
    Result<void> write(const std::string& file, std::string_view content) override;
    Result<void> savePicture(const std::string& file, const ReportPicture& picture) override;
    bool has(const std::string& file) const override;
    void remove(const std::string& file) override;
    bool mayBeReplaced() const override { return fresh_; }
    std::optional<std::string> read(const std::string& file) const override;

    /// Makes report.html from the JSON that is there, by a script of perf/pages, so that it can be
    /// made again. Fails: FileUnwritable, saying that `written` are there and how to make the page.
    Result<void> makePage(const std::string& script, const std::string& written) const;

private:
    std::filesystem::path path_;
    std::string inner_;
    bool fresh_;
    bool made_; // nothing was there before
    std::optional<Unfinished> unfinished_;
    std::optional<Unfinished> unfinishedInner_;
};

/// This run, of the command as it was typed.
RunInfo runOf(const std::string& command);

} // namespace slabcast

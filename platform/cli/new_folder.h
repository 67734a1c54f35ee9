#pragma once

#include <filesystem>

#include "platform/cli/report_files.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

/// The folder for a report, made before long work; gone again, if it was made here, where that work
/// fails before anything is written.
class NewFolder {
public:
    explicit NewFolder(std::filesystem::path path)
        : path_(std::move(path)), made_(!std::filesystem::exists(path_)) {}
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    ~NewFolder() {
        std::error_code ignored;
        if (made_) {
            std::filesystem::remove(path_, ignored); // only where it is empty
        }
    }

    /// Fails: FileUnwritable, also where `file` could not be written in it.
    Result<void> make(const char* file) const {
        return makeReportFolder(path_).and_then([&] { return checkWritable(path_ / file); });
    }
    Result<void> write(const char* file, const std::string& content) const {
        return writeFileAtomically(path_ / file, content);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    bool made_;
};

} // namespace slabcast

#pragma once

#include <map>
#include <set>
#include <string>

#include "perf/report_folder.h"

namespace slabcast {

/// A report's folder that is only in memory.
class MemoryFolder : public ReportFolder {
public:
    std::string name() const override { return "memory"; }
    Result<void> write(const std::string& file, std::string_view content) override {
        files[file] = content;
        return {};
    }
    Result<void> savePicture(const std::string& file, const ReportPicture&) override {
        files[file] = "a picture";
        return {};
    }
    bool has(const std::string& file) const override { return files.contains(file); }
    void remove(const std::string& file) override { files.erase(file); }
    bool mayBeReplaced() const override { return replaceable; }
    std::optional<std::string> read(const std::string& file) const override {
        const auto found = files.find(file);
        return found == files.end() ? std::nullopt : std::optional(found->second);
    }

    std::map<std::string, std::string> files;
    bool replaceable = false;
};

} // namespace slabcast

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"

namespace slabcast {

/// Top row first, sRGB-encoded, opaque.
struct ReportPicture {
    glm::ivec2 size{0};
    std::vector<glm::vec4> pixels;
};

/// Box-filtered to an edge that suits a page. `picture` is of `size`.
/// Tested by: heatmap_test.cpp
ReportPicture thumbnail(glm::ivec2 size, const std::vector<glm::vec4>& picture);

/// Where a report's files go: the program that measures has it, the library only names files in it,
/// as "sweep.json" or "pictures/a.png".
class ReportFolder {
public:
    virtual ~ReportFolder() = default;

    /// As people know the folder; for messages.
    virtual std::string name() const = 0;
    /// Replaces the file, wholly or not at all. Fails: FileUnwritable.
    virtual Result<void> write(const std::string& file, std::string_view content) = 0;
    /// The same of a picture as PNG.
    virtual Result<void> savePicture(const std::string& file, const ReportPicture& picture) = 0;
    virtual bool has(const std::string& file) const = 0;
    /// Leaves nothing of this name; where that cannot be, leaves it.
    virtual void remove(const std::string& file) = 0;
    /// Whether a run that it holds may be replaced by another: somebody asked for that.
    virtual bool mayBeReplaced() const { return false; }
    /// All of it; nothing where it is missing or cannot be read.
    virtual std::optional<std::string> read(const std::string& file) const = 0;
};

} // namespace slabcast

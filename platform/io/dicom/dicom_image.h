#pragma once

#include <string>
#include <vector>

#include "platform/io/dicom/dicom_file.h"

namespace slabcast {

/// One frame of one file, and where it lies: what a volume is stacked from.
struct DicomImage {
    const DicomFile* file = nullptr;
    int index = 0; // of the frame in its file
    glm::dvec3 positionMm{0.0};
    glm::dmat2x3 axes{1.0};
    glm::dvec2 spacingMm{1.0};
    double alongMm = 0.0; // along the normal that all share

    const DicomFrame& frame() const { return file->frames[static_cast<std::size_t>(index)]; }
    /// Empty where the file is silent.
    std::string property(const std::string& keyword) const {
        const auto found = frame().properties.find(keyword);
        return found == frame().properties.end() ? "" : found->second;
    }
    /// "003.dcm", or "frame 4 of heart.dcm"; in a message that begins with the file, "frame 4".
    std::string name(const std::filesystem::path& where) const {
        if (file->frames.size() == 1) {
            return file->path.filename().string();
        }
        const std::string frameName = "frame " + std::to_string(index + 1);
        return where == file->path ? frameName
                                   : frameName + " of " + file->path.filename().string();
    }
};

using DicomImages = std::vector<DicomImage>;

} // namespace slabcast

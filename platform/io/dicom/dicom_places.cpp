#include "platform/io/dicom/dicom_places.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

std::optional<glm::dmat2x3> axesOf(DicomFile& file, const std::string& text) {
    constexpr double kTolerance = 1e-2; // files round cosines to a few digits
    const auto six = take(file, "ImageOrientationPatient", text, 6);
    if (!six) {
        return std::nullopt;
    }
    const std::vector<double>& c = *six;
    const glm::dmat2x3 axes(c[0], c[1], c[2], c[3], c[4], c[5]);
    const double row = glm::length(axes[0]);
    const double column = glm::length(axes[1]);
    if (!(std::abs(row - 1) < kTolerance && std::abs(column - 1) < kTolerance &&
          std::abs(glm::dot(axes[0], axes[1])) < kTolerance)) {
        if (!file.fault) {
            file.fault = Error{
                ErrorCode::InvalidGeometry,
                fmt::format("{}: ImageOrientationPatient is '{}', which are not two directions at "
                            "right angles; correct the element or export the file again",
                            file.path.string(), oneLine(text))};
        }
        return std::nullopt;
    }
    return glm::dmat2x3(axes[0] / row, axes[1] / column);
}

std::optional<glm::dvec3> positionOf(DicomFile& file, const std::string& text) {
    const auto three = take(file, "ImagePositionPatient", text, 3);
    return three ? std::optional(glm::dvec3((*three)[0], (*three)[1], (*three)[2])) : std::nullopt;
}

/// Distances between pixels, from the element that classes agree on or from those that stand for
/// it.
void setSpacing(DicomFile& file, DicomFrame& frame, const DicomHeader& header, int index) {
    const std::array<std::pair<const char*, DcmTagKey>, 3> elements = {
        {{"PixelSpacing", DCM_PixelSpacing},
         {"ImagerPixelSpacing", DCM_ImagerPixelSpacing},
         {"NominalScannedPixelSpacing", DCM_NominalScannedPixelSpacing}}};
    for (const auto& [keyword, tag] : elements) {
        const std::string text = header.text(tag, index);
        if (text.empty()) {
            continue;
        }
        const std::optional<std::vector<double>> two = numbersIn(text);
        if (!two || two->size() != 2 || !((*two)[0] > 0 && (*two)[1] > 0)) {
            file.spacingFault = fmt::format("{} is '{}', which are not two positive numbers",
                                            keyword, oneLine(text));
            return;
        }
        frame.spacingMm = glm::dvec2((*two)[1], (*two)[0]); // DICOM's first is between rows
        const std::string note = fmt::format(
            "PixelSpacing is missing; {} was taken, which may hold at the detector only", keyword);
        if (tag != DCM_PixelSpacing &&
            std::find(file.notes.begin(), file.notes.end(), note) == file.notes.end()) {
            file.notes.push_back(note);
        }
        return;
    }
}

/// Planes of a dose: DICOM PS3.3, C.8.8.3.2.
void placeByOffsets(DicomFile& file, const std::string& text, const glm::dvec3& first,
                    const glm::dmat2x3& axes) {
    const auto offsets = take(file, "GridFrameOffsetVector", text, file.frames.size());
    if (!offsets) {
        return;
    }
    const glm::dvec3 normal = glm::cross(axes[0], axes[1]);
    const double start = offsets->front();
    const bool isAbsolute = start != 0.0; // then along z of the patient
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        const double along = ((*offsets)[i] - start) * (isAbsolute && normal.z < 0 ? -1.0 : 1.0);
        file.frames[i].positionMm = first + along * normal;
        file.frames[i].axes = axes;
    }
}

/// Frames whose places are not given one by one, if a distance between them is.
void placeByDistance(DicomFile& file, const DicomHeader& header, std::optional<glm::dvec3> first,
                     std::optional<glm::dmat2x3> axes) {
    const bool spaced = !header.text(DCM_SpacingBetweenSlices, 0).empty();
    const char* keyword = spaced ? "SpacingBetweenSlices" : "SliceThickness";
    const std::string text = header.text(spaced ? DCM_SpacingBetweenSlices : DCM_SliceThickness, 0);
    const auto distance = take(file, keyword, text, 1);
    if (!distance || distance->front() == 0.0 || file.isOverTime) {
        return;
    }
    file.notes.push_back(
        fmt::format("the places of single frames are missing; in the file's order they were laid "
                    "{} mm apart, as {} says{}",
                    std::abs(distance->front()), keyword,
                    first && axes ? "" : ", at an assumed place (no ImagePositionPatient)"));
    const glm::dmat2x3 assumed = axes.value_or(glm::dmat2x3(1, 0, 0, 0, 1, 0));
    const glm::dvec3 step = distance->front() * glm::cross(assumed[0], assumed[1]);
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        file.frames[i].positionMm = first.value_or(glm::dvec3(0.0)) + static_cast<double>(i) * step;
        file.frames[i].axes = assumed;
    }
}

} // namespace

void setPlaces(DicomFile& file, const DicomHeader& header) {
    const int count = static_cast<int>(file.frames.size());
    for (int i = 0; i < count; ++i) {
        DicomFrame& frame = file.frames[i];
        setSpacing(file, frame, header, i);
        frame.axes = axesOf(file, header.text(DCM_ImageOrientationPatient, i));
        const std::optional<std::string> own = header.ofFrame(DCM_ImagePositionPatient, i);
        if (own || count == 1) {
            frame.positionMm =
                positionOf(file, own ? *own : header.text(DCM_ImagePositionPatient, i));
        }
    }
    const bool placed = std::any_of(file.frames.begin(), file.frames.end(),
                                    [](const DicomFrame& frame) { return frame.positionMm; });
    if (placed || count == 1) {
        return;
    }
    std::string place = header.placeText(DCM_ImagePositionPatient);
    place = place.empty() ? header.text(DCM_ImagePositionPatient, 0) : place;
    const std::optional<glm::dvec3> first = positionOf(file, place);
    const std::optional<glm::dmat2x3> axes =
        file.frames.front().axes ? file.frames.front().axes
                                 : axesOf(file, header.placeText(DCM_ImageOrientationPatient));
    const std::string offsets = header.text(DCM_GridFrameOffsetVector);
    if (!offsets.empty() && first && axes) {
        placeByOffsets(file, offsets, *first, *axes);
    } else {
        placeByDistance(file, header, first, axes);
    }
}

} // namespace slabcast
